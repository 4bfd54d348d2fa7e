// What is shared draws the same again: links here, commands and files in the program.
import assert from "node:assert/strict";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { drawn, launch, open, page_fragments, program, program_fragments, run, serve, table_fragments } from "./support.mjs";

let server, browser, folder;
before(async () => {
  server = await serve();
  browser = await launch();
  folder = await mkdtemp(join(tmpdir(), "quadrille_page_"));
});
after(async () => {
  await browser?.close();
  server?.close();
  await rm(folder, { recursive: true, force: true });
});

const states = [
  // hash; whether the program's picture is the page's too, of which the page warns: a file of quads has no texture and
  // no light of its own.
  ["#scene=fig10_concave", true],
  ["#scene=fig10_concave&shade=lambda&significand_bits=10&subpixel_bits=4", true],
  ["#scene=fig6_cuts", true],
  ["#scene=bloomenthal10_a&size=256x200", true],
  ["#scene=phong_mesh&cull=back", true],
  ["#scene=sphere", true],
  ["#scene=fig7_floor&perspective=0&depth=0", true],
  ["#scene=fig10_convex&yaw=31.5&pitch=-12&dolly=0.25", true],
  ["#scene=fig8_behind&v1=0.4,0.1,-0.7&significand_bits=12&shade=lambda", true],
  ["#scene=fig10_convex&v2=0.9,1.1,3.8", true],  // partly in front of the near plane
  ["#scene=fig10_concave&shade=depth", true],
  ["#scene=fig10_concave&texture=grid", false],
  ["#scene=bloomenthal10_a&yaw=9", false],
  ["#scene=sphere&yaw=20&pitch=35&dolly=0.5", false],
  ["#scene=phong_mesh_smooth&yaw=-40&cull=front&significand_bits=14", false],
];
const request = (hash) => hash.slice(1).replaceAll("&", "\n");
const click = async (page, id, done) => {
  await page.click(`#${id}`);
  await page.waitForFunction((text) => document.getElementById("shared").textContent === text, done);
  return page.evaluate(() => navigator.clipboard.readText());
};
/** Size and hash of every byte of the machine's picture, or of a PNG. */
const pixels = (page, png) =>
  page.evaluate(async (base64) => {
    let canvas = document.getElementById("machine");
    if (base64) {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
      canvas = Object.assign(document.createElement("canvas"), { width: bitmap.width, height: bitmap.height });
      canvas.getContext("2d").drawImage(bitmap, 0, 0);
    }
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const hash = [...new Uint8Array(await crypto.subtle.digest("SHA-256", data))].join(" ");
    return `${canvas.width}x${canvas.height} ${hash}`;
  }, png?.toString("base64"));
const download = async (page, id) => {
  const [file] = await Promise.all([page.waitForEvent("download"), page.click(`#${id}`)]);
  const path = join(folder, file.suggestedFilename());
  await file.saveAs(path);
  return path;
};

for (const [hash, same_picture] of states)
  test(`the command of ${hash} draws the same`, async () => {
    const { page, problems, close } = await open(browser, server.address, `${hash}&view=`);
    const note = same_picture ? "" : " It draws the same fragments, in colours of the program's own.";
    const command = await click(page, "copy_command", `Command copied.${note}`);
    const shell = (text) =>
      run("bash", ["-euc", text], { cwd: folder, maxBuffer: 2 ** 30, env: { ...process.env, PATH: `${dirname(program)}:${process.env.PATH}` } });
    const table = command.replace("quadrille render", "quadrille fragments").replace("--png page.png", "--out - --quiet");
    const { stdout } = await shell(table);
    const ours = await page_fragments(page, request(hash));
    assert.ok(ours.fragments > 100);
    assert.deepEqual(ours, table_fragments(stdout));
    await shell(command);
    assert.equal((await pixels(page)) === (await pixels(page, await readFile(join(folder, "page.png")))), same_picture);
    await close();
    assert.deepEqual(problems, []);
  });

test("a link opens the same page, and is short", async () => {
  const hash = "#preset=fig10_crossed&yaw=12.25&quad=;;1,0.9,0.3&s=11&quadratic=20&view=split02&difference=1&theme=dark&shade=lambda";
  const first = await open(browser, server.address, hash);
  const link = await click(first.page, "copy_link", "Link copied.");
  assert.equal(link, server.address + hash);
  const second = await open(browser, server.address, link.slice(server.address.length));
  assert.equal(await pixels(second.page), await pixels(first.page));
  for (const [id, value] of [["view", "split02"], ["shade", "lambda"], ["key_significand_bits", "11"]])
    assert.equal(await second.page.inputValue(`#${id}`), value);
  assert.equal(await second.page.inputValue("#difference"), "1");
  assert.equal(await second.page.evaluate(() => document.documentElement.dataset.theme), "dark");
  await second.page.evaluate((text) => (location.hash = text), hash.replace("theme=dark", "theme=light"));
  await second.page.waitForFunction(() => document.documentElement.dataset.theme === "light");
  // Long names are read, standard values are not written; a beginning names the first scene that has it.
  for (const [long, short] of [
    ["#scene=fig10_crossed&yaw=12.25&v2=1,0.9,0.3&significand_bits=11&quadratic_frac_bits=20&view=split02&difference=1&theme=dark&shade=lambda", hash],
    ["#scene=sphere&significand_bits=18&guard_bits=2&tile_log2=3&subpixel_bits=8", "#preset=sphere&guard=2"],
    ["#quad=0,0,0;1,0,0.5;;-1,2,0.25&s=12&preset=fig10", "#quad=0,0,0;1,0,0.5;;-1,2,0.25&s=12&preset=fig10_convex"],
    ["#v5=1,2,3&embed&preset=sphere", "#v5=1,2,3&embed&preset=sphere"],
    ["#s=12", "#s=12&preset=fig10_convex"],
  ]) {
    await second.page.goto("about:blank");
    await second.page.goto(server.address + long);
    await drawn(second.page);
    assert.equal(await second.page.evaluate(() => window.quadrille.hash()), short);
    await second.page.waitForFunction((text) => location.hash === text, short);
  }
  await first.close();
  await second.close();
  assert.deepEqual([...first.problems, ...second.problems], []);
});

test("each key of a slider is in the address by its short name", async () => {
  const { page, problems, close } = await open(browser, server.address, "#preset=fig10_convex&view=");
  const rows = await page.$$eval("#sliders .slider", (all) =>
    all.map((row) => ({ id: row.querySelector("input").id, short: row.querySelector("label span").textContent.trim() })));
  assert.ok(rows.length >= 8 && rows.some(({ short }) => short === "s"));
  for (const { id, short } of rows) {
    assert.ok(short && id !== `key_${short}`, id);
    const value = await page.$eval(`#${id}`, (input) => String(Number(input.value) - 1));
    await page.locator(`#${id}`).fill(value);
    const hash = await page.evaluate(() => window.quadrille.hash());
    assert.ok(hash.split("&").includes(`${short}=${value}`), `${id}: ${hash}`);
    await page.selectOption("#named", "default");
    assert.equal(await page.evaluate(() => window.quadrille.hash()), "#preset=fig10_convex&view=");
  }
  await close();
  assert.deepEqual(problems, []);
});

test("files: quads and a configuration for the program, a picture", async () => {
  const hash = "#scene=bowtie&yaw=5&significand_bits=13&align_guard_bits=1";
  const { page, problems, close } = await open(browser, server.address, `${hash}&view=`);
  const quads = await download(page, "save_quads"), toml = await download(page, "save_toml");
  const csv = await program_fragments(["--quads", quads, "--config", toml]);
  assert.deepEqual(await page_fragments(page, request(hash)), table_fragments(csv));
  const png = await readFile(await download(page, "save_png"));
  assert.equal(await pixels(page, png), await pixels(page));
  await close();
  assert.deepEqual(problems, []);
});

test("embedded there is the picture alone", async () => {
  const { page, close } = await open(browser, server.address, "#scene=fig10_convex&view=&embed");
  assert.ok(await page.isVisible("#machine"));
  for (const part of ["header", "aside", "footer"]) assert.ok(!(await page.isVisible(part)), part);
  await close();
});
