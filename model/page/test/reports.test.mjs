// Links of a sweep's report and of the papers' figures open the page as what they stand for.
import assert from "node:assert/strict";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { drawn, launch, open, program, root, run, serve } from "./support.mjs";

let folder, browser, server;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), "quadrille_reports_"));
  browser = await launch();
  server = await serve(folder);
});
after(async () => {
  await browser?.close();
  server?.close();
  await rm(folder, { recursive: true, force: true });
});

const settled = (page) => page.waitForFunction(() => window.quadrille?.all_settled() ?? false, null, { timeout: 60000 });

test("a point of a sweep", async () => {
  const sweep = join(folder, "sweep");
  await run(program, ["sweep", "--scene", "fig10_concave", "--size", "64x64", "--cosim", "none", "--quiet", "--out", sweep, "--set", "guard_bits=2",
    "--axis", "significand_bits=10,14,18", "--axis", "subpixel_bits=6,8"]);
  await run(join(root, "scripts/sweep_report.py"), [sweep, "--page", "/page/index.html", "--out", join(folder, "report")]);
  const [head, ...lines] = (await readFile(join(sweep, "points.csv"), "utf8")).trimEnd().split("\n").map((line) => line.split(","));
  const points = new Map(lines.map((cells) => [cells[0], Object.fromEntries(head.map((name, i) => [name, cells[i]]))]));
  const { page, problems, close } = await open(browser, server.address, "page/index.html#view=");
  const opens = async (row) => {
    await drawn(page);
    const shown = await page.evaluate(async () => (await window.quadrille.call("configuration", window.quadrille.config())).result.resolved);
    const point = points.get(row);
    for (const [key, value] of Object.entries(shown)) assert.equal(value, Number(point[key]), `row ${row}: ${key}`);
    assert.equal(await page.inputValue("#scene"), "fig10_concave");
    const hash = await page.evaluate(() => window.quadrille.hash());
    assert.ok(hash.length < 80, hash);
  };
  await page.goto(`${server.address}report/report.html`);
  // A mark that was clicked has a link, and so have the rows of tables.
  await page.waitForFunction(() => document.querySelector("#plot-error_cost")?._fullLayout);
  await page.evaluate(() => {
    const plot = document.querySelector("#plot-error_cost");
    plot.emit("plotly_click", { points: [{ customdata: 1 }] });
  });
  const links = new Map(await page.$$eval("a[href*='index.html#']", (all) => all.filter((a) => /^\d+$/.test(a.textContent)).map((a) => [a.textContent, a.href])));
  assert.ok(links.size >= 3, [...links.keys()].join());
  await page.click("#pin-error_cost a");
  await opens("1");
  for (const [row, address] of links) {
    await page.goto("about:blank");
    await page.goto(address);
    await opens(row);
  }
  await close();
  assert.deepEqual(problems, []);
});

test("a sheet of a figure", async () => {
  // As scripts/figures_test.py finds them in the page of figures, which takes programs that this tier has not.
  const list = `import figures
for figure in figures.read_table()[1]:
    for sheet in figure.sheet if figure.name == "hormann_tarini7" else []:
        print(figures.page_link(sheet, "64x64", "page/index.html"))`;
  const { stdout } = await run("/usr/bin/python3", ["-c", list], { cwd: join(root, "scripts") });
  const { page, problems, close } = await open(browser, server.address, "page/index.html#view=");
  await page.setContent(stdout);
  const links = await page.$$eval("a", (all) => all.map((link) => link.getAttribute("href")));
  assert.equal(links.length, 2);
  for (const [i, perspective] of [[0, false], [1, true]]) {
    await page.goto("about:blank");
    await page.goto(server.address + links[i]);
    await settled(page);
    assert.equal(await page.inputValue("#scene"), "fig7_floor");
    assert.equal(await page.inputValue("#view"), "split02");
    assert.equal(await page.isChecked("#perspective"), perspective);
    assert.equal(await page.evaluate(() => document.getElementById("machine").width), 64);
  }
  await close();
  assert.deepEqual(problems, []);
});
