// The formulas in fp32 by WebGL2: near the truth, as far as fp32 allows; a wrong shader is not.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { weight_bounds } from "./fp32_bound.mjs";
import { launch, open, page_folder, program_fragments, serve } from "./support.mjs";

let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
});

const size = 128;
const scenes = ["fig10_convex", "fig10_concave", "fig10_crossed", "fig7_floor", "fig8_behind", "fig9_e", "phong_mesh"];

/** By pixel the quad and its exact weights, where something is seen. */
async function exact_pixels(scene) {
  const csv = await program_fragments(["--scene", scene, "--size", `${size}x${size}`, "--engine", "truth"]);
  const pixels = new Map();
  for (const row of csv.trimEnd().split("\n").slice(1)) {
    const [quad, x, y, front, , l0, l1, l2, l3, z] = row.split(",").map(Number), at = y * size + x;
    if (!pixels.has(at) || z < pixels.get(at).z) pixels.set(at, { quad, x, y, front, z, lambda: [l0, l1, l2, l3] });
  }
  return pixels;
}

/** What the shader drew: of each pixel the quad or -1, front, z, weights; and its quads. */
async function shader_pixels(page, scene, form) {
  const answer = await page.evaluate(
    async (text) => {
      const { result, bytes, error } = await window.quadrille.call("shader", text);
      return error ? { error } : { quads: result.vertices, floats: [...new Float32Array(bytes)] };
    },
    `scene=${scene}\nsize=${size}x${size}\nview=fp32${form === "printed" ? "" : "_determinant"}`,
  );
  assert.equal(answer.error, undefined);
  const { floats } = answer, half = floats.length / 2;
  return {
    quads: answer.quads,
    pixels: Array.from({ length: size * size }, (_, i) => ({
      quad: floats[half + 4 * i] - 1,
      z: floats[half + 4 * i + 1],
      front: floats[half + 4 * i + 2] < 0 ? 1 : 0,
      lambda: floats.slice(4 * i, 4 * i + 4),
    })),
  };
}

/** Distance in pixels to the nearest line of an edge or a diagonal. */
function distance(quad, px, py) {
  const corner = (i) => [quad[i], quad[4 + i], quad[8 + i]];
  return Math.min(
    ...[[0, 1], [1, 2], [2, 3], [3, 0], [2, 0]].map(([i, j]) => {
      const [ax, ay, aw] = corner(i), [bx, by, bw] = corner(j);
      const nx = ay * bw - by * aw, ny = aw * bx - bw * ax;
      assert.ok(nx !== 0 || ny !== 0);
      return Math.abs(nx * px + ny * py + ax * by - bx * ay) / Math.hypot(nx, ny);
    }),
  );
}

async function compare(page, scene, form) {
  const exact = await exact_pixels(scene), { quads, pixels } = await shader_pixels(page, scene, form);
  const found = { compared: 0, wrong: 0, without_bound: 0, undefined: 0, elsewhere: 0, worst: 0 };
  for (let at = 0; at < pixels.length; at++) {
    const of = pixels[at], truth = exact.get(at), x = at % size, y = (at - x) / size;
    if (of.quad < 0 && !truth) continue;
    if (of.quad !== (truth?.quad ?? -1)) {
      // WebGL moves corners to its own grid, of at least 4 bits: edges move by less than a tenth of a pixel.
      const between = [of.quad, truth?.quad ?? -1].filter((quad) => quad >= 0);
      found.elsewhere += between.every((quad) => distance(quads.slice(20 * quad, 20 * quad + 20), x, y) > 0.1) ? 1 : 0;
      continue;
    }
    if (!of.lambda.every(Number.isFinite)) {
      ++found.undefined;
      continue;
    }
    ++found.compared;
    const bounds = weight_bounds(form, quads.slice(20 * of.quad, 20 * of.quad + 20), x, y, size);
    const errors = of.lambda.map((l, i) => Math.abs(l - truth.lambda[i]));
    found.worst = Math.max(found.worst, ...errors.slice(1));
    if (!bounds.every(Number.isFinite)) ++found.without_bound;
    if (errors.some((e, i) => e > bounds[i]) || of.front !== truth.front) ++found.wrong;
  }
  return found;
}

test("both forms have the exact weights within what fp32 may lose", async () => {
  const { page, problems, close } = await open(browser, server.address, "#view=");
  for (const form of ["printed", "determinant"])
    for (const scene of scenes) {
      const found = await compare(page, scene, form);
      console.log(`${form}, ${scene}: ${JSON.stringify(found)}`);
      assert.ok(found.compared > 1000, `${form}, ${scene}`);
      assert.equal(found.wrong + found.elsewhere, 0, `${form}, ${scene}`);
      // Where A cancels the printed form has no bound.
      assert.ok(found.without_bound + found.undefined < found.compared / (form === "printed" ? 10 : 100), `${form}, ${scene}`);
    }
  await close();
  assert.deepEqual(problems, []);
});

test("a wrong shader has not", async () => {
  const script = await readFile(join(page_folder, "worker.js"), "utf8");
  for (const [form, search, by, scene = "fig10_convex"] of [
    ["printed", "product - inner", "product - 0.9999 * inner"],
    ["printed", "t.wxyz + t", "t.wxyz + 1.001 * t"],
    ["determinant", "r.x * a.x - r.y", "r.x * a.x - 0.9999 * r.y"],
    ["determinant", "found.a - found.t * n", "found.a - 0.9999 * found.t * n"],
    ["determinant", "origin.x * w", "1.0001 * origin.x * w"],
    ["determinant", "first ? found.a.y : -found.a.y", "first ? found.a.y : found.a.y", "fig10_crossed"],
    ["printed", "(facing < 0.0", "(facing > 0.0", "culled"],
  ]) {
    assert.equal(script.split(search).length, 2, search);
    const { page, close } = await open(browser, server.address, "#view=", {}, (context) =>
      context.route("**/worker.js", (route) => route.fulfill({ contentType: "text/javascript", body: script.replace(search, by) })),
    );
    if (scene === "culled") {
      const { result } = await page.evaluate(() => window.quadrille.call("view", "scene=fig10_convex\ncull=back\nview=fp32"));
      assert.equal(result.fragments, 0, search);
    } else {
      const found = await compare(page, scene, form);
      assert.ok(found.wrong + found.undefined + found.elsewhere > 300, `${search}: ${JSON.stringify(found)}`);
    }
    await close();
  }
});

test("culled and seen as the machine sees them; the heat map knows the worst error", async () => {
  const { page, problems, close } = await open(browser, server.address, "#view=");
  const view = (text) => page.evaluate((t) => window.quadrille.call("view", t), text);
  for (const form of ["fp32", "fp32_determinant"]) {
    assert.equal((await view(`scene=fig10_convex\ncull=front\nview=${form}`)).result.fragments, 0);
    assert.ok((await view(`scene=fig10_convex\ncull=back\nview=${form}`)).result.fragments > 90000);
    for (const scene of ["fig10_convex", "fig8_behind"]) {
      const found = await compare(page, scene, form === "fp32" ? "printed" : "determinant");
      const { result } = await view(`scene=${scene}\nsize=${size}x${size}\nview=${form}_error`);
      assert.ok(Math.abs(result.worst * result.bound - found.worst) <= 1e-12, `${scene}: ${result.worst * result.bound}, ${found.worst}`);
      assert.equal(result.undefined, found.undefined);
    }
  }
  await close();
  assert.deepEqual(problems, []);
});

test("both are chosen in the page, as pictures, differences and errors", async () => {
  const { page, problems, close } = await open(browser, server.address, "#preset=fig10_convex");
  const settled = () => page.waitForFunction(() => window.quadrille.all_settled());
  const picture = async () => (await settled(), page.evaluate(() => document.getElementById("beside").toDataURL()));
  const pictures = new Set();
  for (const form of ["fp32", "fp32_determinant"]) {
    await page.selectOption("#view", form);
    for (const shown of ["", "1", "error"]) {
      await page.selectOption("#difference", shown);
      await page.waitForFunction(
        ([view, error]) => document.body.dataset.compared?.endsWith(`view=${view}${error ? "_error" : ""}`),
        [form, shown === "error"],
      );
      pictures.add(await picture());
      assert.equal(/worst error/.test(await page.textContent("#legend")), shown === "error");
    }
  }
  // Both pictures are alike to 8 bits, and so are the differences.
  assert.ok(pictures.size >= 3, String(pictures.size));
  await close();
  assert.deepEqual(problems, []);
});

test("without WebGL2 the view says so, and the others go on", async () => {
  const script = await readFile(join(page_folder, "worker.js"), "utf8");
  const { page, close } = await open(browser, server.address, "#preset=fig10_convex&view=fp32", {}, (context) =>
    context.route("**/worker.js", (route) =>
      route.fulfill({ contentType: "text/javascript", body: `OffscreenCanvas.prototype.getContext = () => null;\n${script}` }),
    ),
  );
  await page.waitForFunction(() => /no WebGL2/.test(document.getElementById("view_note").textContent));
  await page.selectOption("#view", "exact");
  await page.waitForFunction(() => document.body.dataset.compared?.endsWith("view=exact"));
  assert.equal(await page.textContent("#view_note"), "");
  await close();
});
