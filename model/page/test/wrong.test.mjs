// What a visitor gets wrong, or a browser refuses, is said where it is seen; the page goes on.
import assert from "node:assert/strict";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { drawn, launch, open, serve } from "./support.mjs";

let server, browser, opened, page;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
});
beforeEach(async () => {
  opened = await open(browser, server.address, "#preset=fig10_convex&view=", { viewport: { width: 400, height: 800 } });
  page = opened.page;
});
afterEach(async () => {
  await opened.close();
  assert.deepEqual(opened.problems, []);
});

/** The error's text, which lies in the window whole. */
const seen_error = async () => {
  await page.locator("#error").waitFor({ state: "visible" });
  const box = await page.locator("#error").boundingBox();
  assert.ok(box.y >= 0 && box.y + box.height <= 800 && box.x >= 0 && box.x + box.width <= 400, JSON.stringify(box));
  return page.textContent("#error");
};

test("an address with a mistake says what would be right; a good one is drawn then", async () => {
  for (const [hash, text] of [
    ["#preset=fig10_convexx&view=&embed", /fig10_convexx.*fig10_convex/],
    ["#viewport_bits=14", /guard_bits/],
    ["#preset=fig10&yaw=%", /^yaw=%: expected a number/],
    ["#preset=%E0%A4%A", /no scene '%E0%A4%A'/],
    ["#size=512", /^size=512: expected WIDTHxHEIGHT/],
    ["#size=99999x99999", /^size=99999: expected an integer from 1 to 1024/],
    ["#quad=1,2", /^v0=1,2: expected three numbers/],
    ["#quad=;;NaN,0,0", /^v2=NaN: expected a number/],
    ["#texture=own", /choose a picture of your own again/],
    ["#s=99", /significand_bits.*8..26/],
  ]) {
    await page.goto("about:blank");
    await page.goto(server.address + hash);
    assert.match(await seen_error(), text);
    await page.evaluate(() => (location.hash = "#preset=sphere&view="));
    await page.locator("#error").waitFor({ state: "hidden" });
    await drawn(page);
    assert.ok(await page.evaluate(() => window.quadrille.request().includes("scene=sphere")));
  }
});

test("a pixel that is none is refused beside the numbers, and marked nowhere", async () => {
  for (const [pixel, text] of [["abc", /expected X,Y/], ["1", /expected X,Y/], ["7,900", /outside the viewport of 512x512/]]) {
    await page.evaluate((at) => (location.hash = `#preset=fig10_convex&view=&pixel=${at}`), pixel);
    await page.waitForFunction((source) => new RegExp(source).test(document.getElementById("explained").textContent), text.source);
  }
});

test("a slider that asks for an impossible machine says so in sight, and stays where it is", async () => {
  const slider = page.locator("#key_guard_bits");
  await slider.scrollIntoViewIfNeeded();
  const before = await slider.boundingBox();
  await slider.fill("4");
  assert.match(await seen_error(), /lower one of these four/);
  assert.deepEqual(await slider.boundingBox(), before);
  assert.equal(await page.textContent("output[for=key_guard_bits]"), "4");
  await slider.fill("3");
  await page.locator("#error").waitFor({ state: "hidden" });
});

test("corners in one place draw nothing, and the page says why", async () => {
  await page.evaluate(() => (location.hash = "#preset=fig10_convex&quad=0,0,0;0,0,0;0,0,0;0,0,0&pixel=255,255"));
  await page.waitForFunction(() => /^left out: the whole quad/.test(document.getElementById("explained").textContent));
  assert.equal(await page.isVisible("#error"), false);
});

test("a method that draws nothing of a quad says so", async () => {
  await page.evaluate(() => (location.hash = "#preset=fig10_concave&view=projective"));
  await page.waitForFunction(() => document.body.dataset.compared?.endsWith("view=projective"));
  assert.match(await page.textContent("#legend"), /Nothing is drawn/);
});

test("a view that fails leaves no other view's picture under its name", async () => {
  await page.evaluate(() => (location.hash = "#preset=fig10_concave&view=error"));
  await page.waitForFunction(() => document.body.dataset.compared?.endsWith("view=error"));
  assert.match(await page.textContent("#legend"), /worst error/);
  await page.evaluate(() => (location.hash = "#preset=fig10_concave&view=nonsense"));
  await page.waitForFunction(() => /unknown method 'nonsense'/.test(document.getElementById("view_note").textContent));
  assert.equal(await page.textContent("#legend"), "");
  assert.ok(await page.evaluate(() => {
    const canvas = document.getElementById("beside");
    return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.every((byte) => byte === 0);
  }));
});

test("a host that lacks a file is told which", async () => {
  for (const file of ["worker.js", "quadrille.wasm"]) {
    const other = await browser.newPage();
    await other.route(`**/${file}`, (route) => route.fulfill({ status: 404, body: "" }));
    await other.goto(server.address);
    await other.waitForFunction((name) => document.getElementById("error").textContent.startsWith(name), file);
    await other.close();
  }
});

test("where a browser lets nothing be copied, the text stands there, chosen", async () => {
  await page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: undefined }));
  for (const [id, text] of [["copy_link", `${server.address}#preset=fig10_convex&view=`], ["copy_command", "quadrille render --scene fig10_convex --size 512x512 --png page.png"]]) {
    await page.click(`#${id}`);
    await page.waitForFunction((expected) => getSelection().toString() === expected, text);
    assert.match(await page.textContent("#shared"), /does not let/);
  }
});
