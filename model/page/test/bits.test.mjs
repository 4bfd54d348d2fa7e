// The page draws the program's bits.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { drawn, launch, open, page_fragments, program, program_fragments, run, serve, table_fragments } from "./support.mjs";

let server, browser, opened;
before(async () => {
  server = await serve();
  browser = await launch();
  opened = await open(browser, server.address);
});
after(async () => {
  await browser?.close();
  server?.close();
});

test("every figure has the program's fragments", async () => {
  const { page } = opened;
  const { result } = await page.evaluate(() => window.quadrille.call("lists", ""));
  assert.ok(result.scenes.length > 50);
  const values = await page.$$eval("#scene option", (options) => options.map((o) => o.value));
  for (const { name } of result.scenes) {
    assert.ok(values.includes(name), `${name} is a preset`);
    const [ours, csv] = await Promise.all([
      page_fragments(page, `scene=${name}`),
      program_fragments(["--scene", name]),
    ]);
    const theirs = table_fragments(csv);
    assert.ok(ours.fragments > 100, name);
    assert.deepEqual(ours, theirs, name);
  }
});

test("and the named configurations, which draw a texture too", async () => {
  const { page } = opened;
  const { stdout } = await run(program, ["config", "--list"]);
  const names = [...stdout.matchAll(/^ *(\w+) /gm)].map(([, name]) => name).filter((name) => stdout.includes(`${name} `));
  const options = await page.$$eval("#named option", (all) => all.map((o) => o.value));
  assert.ok(names.length >= 4, stdout);
  for (const name of names) {
    const option = options.find((value) => value.startsWith(`${name}: `));
    assert.ok(option, `${name} is offered`);
    await page.selectOption("#named", option);
    await drawn(page);
    assert.equal(await page.isVisible("#error"), false, name);
    assert.equal(await page.inputValue("#named"), option);
    const { stdout: printed } = await run(program, ["config", "--config", name, "--json", "-"]);
    const { config } = JSON.parse(printed), text = await page.evaluate(() => window.quadrille.request());
    const set = Object.entries(config).map(([key, value]) => `${key}=${value === -1 ? "auto" : value}`);
    const csv = await program_fragments(["--scene", "fig10_convex", "--config", name]);
    const ours = await page_fragments(page, text);
    assert.deepEqual(ours, await page_fragments(page, ["scene=fig10_convex", ...set].join("\n")), name);
    assert.deepEqual(ours, table_fragments(csv, 24, config.depth_bits), name);
    // In passes where there are more attributes than slots: all of it is the quad's texture.
    const colours = await page.evaluate(() => {
      const canvas = document.getElementById("machine"), { data } = canvas.getContext("2d").getImageData(0, 0, 512, 512);
      return new Set(new Uint32Array(data.buffer)).size;
    });
    assert.ok(colours > 1000, `${name}: ${colours} colours`);
  }
});

test("so do other configurations and draw states", async () => {
  const { page } = opened;
  for (const [scene, keys, options, attribute_frac] of [
    ["fig10_crossed", { significand_bits: 8 }, [], 24],
    ["fig9_h", { significand_bits: 26, attribute_frac_bits: 28 }, [], 28],
    ["fig8_behind", { subpixel_bits: 2, homogeneous_frac_bits: 4 }, [], 24],
    ["fig10_concave", { quadratic_frac_bits: 18, significand_bits: 12, attribute_slots: 1 }, [], 24],
    ["bowtie", { sqrt_degree: 1, recip_degree: 1, align_guard_bits: 0 }, ["--cull", "back"], 24],
    ["fig7_floor", { significand_bits: 21 }, ["--no-perspective", "--no-depth"], 24],
  ]) {
    const words = { "--cull": "cull=back", "--no-perspective": "perspective=0", "--no-depth": "depth=0" };
    const set = Object.entries(keys);
    const text = [`scene=${scene}`, ...set.map(([k, v]) => `${k}=${v}`), ...options.map((o) => words[o]).filter(Boolean)].join("\n");
    const ours = await page_fragments(page, text);
    const csv = await program_fragments(["--scene", scene, ...options, ...set.flatMap(([k, v]) => ["--set", `${k}=${v}`])]);
    assert.deepEqual(ours, table_fragments(csv, attribute_frac), text);
  }
});
