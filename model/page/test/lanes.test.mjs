// The lanes of the module, which round toward zero by themselves, have the bits of the plain pipeline.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";
import { root } from "./support.mjs";

const none = new Proxy({}, { get: () => () => 52 });
const { instance } = await WebAssembly.instantiate(await readFile(join(root, "build/page-wasm/model/page/page_lanes_check")), {
  wasi_snapshot_preview1: none,
});
const { memory, input, families, compare, _initialize } = instance.exports;
_initialize();

for (const config of ["", "significand_bits=8", "significand_bits=26 attribute_frac_bits=30", "significand_bits=21 align_guard_bits=6",
  "quadratic_frac_bits=12", "subpixel_bits=2 homogeneous_frac_bits=4 align_guard_bits=0", "sqrt_degree=1 recip_degree=1 tile_log2=4",
  "significand_bits=26 sqrt_segments_log2=3 recip_segments_log2=3", "significand_bits=24 sqrt_segments_log2=14 recip_segments_log2=14",
  "viewport_bits=14 guard_bits=1"])
  test(`every stress family, ${config || "default configuration"}`, () => {
    const bytes = new TextEncoder().encode(config), place = input(bytes.length);
    new Uint8Array(memory.buffer, place, bytes.length).set(bytes);
    let fragments = 0;
    for (let family = 0; family < families(); family++) {
      const alike = compare(family, 60, 1);
      assert.ok(alike >= 0, `family ${family} differs`);
      fragments += alike;
    }
    assert.ok(families() > 15 && fragments > 10000, `${fragments}`);
  });
