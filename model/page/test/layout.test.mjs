// Narrow and wide, dark and light: nothing overflows, everything has a name, and what is compared is drawn.
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, launch_watched, open, root, serve } from "./support.mjs";

const shots = join(root, "build/page-shots");
let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
  await mkdir(shots, { recursive: true });
});
after(async () => {
  await browser?.close();
  server?.close();
});

const all_settled = (page) => page.waitForFunction(() => window.quadrille.all_settled(), null, { timeout: 60000 });

for (const width of [400, 1400])
  for (const theme of ["light", "dark"])
    test(`${width} pixels wide, ${theme}`, async () => {
      const hash = `#scene=fig10_concave&theme=${theme}&pixel=240,255`;
      const { page, problems, close } = await open(browser, server.address, hash, { viewport: { width, height: 900 } });
      await all_settled(page);
      await page.screenshot({ path: join(shots, `${width}_${theme}.png`), fullPage: true });
      const overflow = await page.evaluate(() => {
        const limit = document.documentElement.clientWidth;
        return [...document.querySelectorAll("body *")]
          .filter((e) => e.checkVisibility() && !e.closest("svg, .hidden") && e.getBoundingClientRect().right > limit + 0.5)
          .map((e) => e.id || e.tagName);
      });
      assert.deepEqual(overflow, []);
      const beyond_panel = await page.$$eval("fieldset, .pixel, header", (panels) =>
        panels.flatMap((panel) => [...panel.querySelectorAll("*")]
          .filter((e) => e.checkVisibility() && !e.closest("svg, .hidden, .wide") && e.getBoundingClientRect().right > panel.getBoundingClientRect().right)
          .map((e) => e.id || e.tagName)));
      assert.deepEqual(beyond_panel, []);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
      const hidden_columns = await page.$$eval("#explained details", (stages) =>
        stages.filter((stage) => {
          stage.open = true;
          const table = stage.querySelector(".wide");
          return table && table.scrollWidth > table.clientWidth;
        }).map((stage) => stage.dataset.stage));
      assert.deepEqual(hidden_columns, []);
      if (width > 1000) {
        const hint = await page.locator("#hint").boundingBox();
        assert.ok(hint.y + hint.height < 900, "what one can do is read without scrolling");
      }
      // Text against what is behind it, by WCAG's formula.
      const contrast = await page.evaluate(() => {
        const luminance = (colour) => {
          const [r, g, b] = colour.match(/[\d.]+/g).map((c) => (c / 255 <= 0.03928 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
          return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const behind = (e) => {
          for (; e; e = e.parentElement) {
            const colour = getComputedStyle(e).backgroundColor;
            if (!/, 0\)$|transparent/.test(colour)) return colour;
          }
          return "rgb(255, 255, 255)";
        };
        return [...document.querySelectorAll("body *")]
          .filter((e) => e.checkVisibility() && !e.closest("svg") && [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim()))
          .map((e) => {
            const [a, b] = [luminance(getComputedStyle(e).color), luminance(behind(e))];
            return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), e.id || e.className || e.tagName];
          })
          .filter(([ratio]) => ratio < 4.5);
      });
      assert.deepEqual(contrast, []);
      await close();
      assert.deepEqual(problems, []);
    });

test("on a phone a slider and the picture that it changes are seen at once", async () => {
  const { page, problems, close } = await open(browser, server.address, "#scene=fig10_convex", { viewport: { width: 400, height: 800 } });
  const slider = page.locator("#sliders input").nth(2);
  await page.locator("#named").focus();
  await slider.focus();
  const [picture, control] = [await page.locator("#machine").boundingBox(), await slider.boundingBox()];
  assert.ok(picture.y >= 0 && picture.y + picture.height <= control.y && control.y + control.height <= 800, JSON.stringify([picture, control]));
  await close();
  assert.deepEqual(problems, []);
});

test("both pictures lie side by side, also as pictures of a slide", async () => {
  for (const [hash, width] of [["#preset=fig10_convex&view=fp32", 1400], ["#preset=fig10_convex&view=split02", 1000], ["#preset=fig10_convex&view=split02&embed", 800]]) {
    const { page, close } = await open(browser, server.address, hash, { viewport: { width, height: 900 } });
    await all_settled(page);
    const [a, b] = [await page.locator("#machine").boundingBox(), await page.locator("#beside").boundingBox()];
    assert.ok(a.y === b.y && a.height === b.height && a.x + a.width < b.x, `${hash}: ${JSON.stringify([a, b])}`);
    await close();
  }
});

test("handles and the cross at a pixel are as large whatever the size of the picture", async () => {
  const { page, problems, close } = await open(browser, server.address, "#preset=fig10_convex&view=");
  for (const size of ["64x64", "300x200", "1024x1024"]) {
    await page.evaluate((of) => (location.hash = `#preset=fig10_convex&view=&size=${of}&pixel=31,31`), size);
    await page.waitForFunction((width) => document.getElementById("machine").width === width, Number(size.split("x")[0]));
    await all_settled(page);
    const unit = (await page.locator("#machine").boundingBox()).width;
    const dot = await page.locator(".handle .dot").first().boundingBox();
    assert.ok(dot.width > unit / 60 && dot.width < unit / 30, `${size}: ${dot.width} of ${unit}`);
    const cross = await page.locator("#handles .cross").boundingBox();
    assert.ok(cross.width > unit / 60 && cross.width < unit / 12, `${size}: ${cross.width} of ${unit}`);
  }
  await close();
  assert.deepEqual(problems, []);
});

test("on a telephone a finger scrolls past the picture beside, and both choices of it are read", async () => {
  const options = { viewport: { width: 400, height: 800 }, hasTouch: true, isMobile: true };
  const { page, close } = await open(browser, server.address, "#preset=fig10_convex&view=fp32", options);
  await all_settled(page);
  const [view, shown] = [await page.locator("#view").boundingBox(), await page.locator("#difference").boundingBox()];
  assert.ok(shown.y >= view.y + view.height && view.width > 250);
  const client = await page.context().newCDPSession(page);
  const scrolled = async (id) => {
    const { x, y } = await page.locator(id).boundingBox(), before = await page.evaluate(() => scrollY);
    const touch = (type, ...up) => client.send("Input.dispatchTouchEvent", { type, touchPoints: up.map((by) => ({ x: x + 20, y: y + 250 - by })) });
    await touch("touchStart", 0);
    for (let up = 15; up <= 150; up += 15) await touch("touchMove", up);
    await touch("touchEnd");
    return (await page.evaluate(() => scrollY)) - before;
  };
  assert.equal(await scrolled("#machine"), 0);  // which turns the quad
  await page.locator("#beside").scrollIntoViewIfNeeded();
  assert.ok((await scrolled("#beside")) > 50);
  await close();
});

test("colours of a legend differ to colour-blind eyes too", async () => {
  const { page, close } = await open(browser, server.address, "#preset=fig10_crossed");
  const client = await page.context().newCDPSession(page);
  for (const view of ["coverage", "tiles"]) {
    await page.selectOption("#view", view);
    await page.waitForFunction((name) => document.body.dataset.compared?.endsWith(`view=${name}`), view);
    for (const type of ["none", "protanopia", "deuteranopia", "tritanopia"]) {
      await client.send("Emulation.setEmulatedVisionDeficiency", { type });
      const colours = [];
      for (const swatch of await page.locator("#legend .swatch").all()) {
        const shot = (await swatch.screenshot()).toString("base64");
        colours.push(await page.evaluate(async (base64) => {
          const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
          context.drawImage(bitmap, 0, 0);
          return [...context.getImageData(bitmap.width >> 1, bitmap.height >> 1, 1, 1).data].slice(0, 3);
        }, shot));
      }
      assert.ok(colours.length >= 4);
      // In CIE's L*a*b*, where a difference of 2.3 is just seen; of areas apart several of these.
      const lab = colours.map(to_lab);
      for (let i = 0; i < lab.length; i++)
        for (let j = 0; j < i; j++) {
          const apart = Math.hypot(...[0, 1, 2].map((c) => lab[i][c] - lab[j][c]));
          assert.ok(apart > 4 * 2.3, `${view}, ${type}: ${colours[i]} and ${colours[j]} are ${apart.toFixed(1)} apart`);
        }
    }
  }
  await close();
});

/** Of sRGB, D65. */
function to_lab(rgb) {
  const [r, g, b] = rgb.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
  const [x, y, z] = [
    (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
    0.2126 * r + 0.7152 * g + 0.0722 * b,
    (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
  ].map((t) => (t > (6 / 29) ** 3 ? Math.cbrt(t) : t / (3 * (6 / 29) ** 2) + 4 / 29));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

test("every control has a name", async () => {
  const { page, close } = await open(browser, server.address);
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, select, input, canvas, [role=button]")]
      .filter((e) => !(e.ariaLabel || e.labels?.length || e.textContent.trim()))
      .map((e) => e.id || e.tagName),
  );
  assert.deepEqual(nameless, []);
  await close();
});

test("each comparison draws, within 2 seconds of a processor for one quad", async () => {
  const watched = await launch_watched();
  const { page, problems } = await open(watched.browser, server.address, "#scene=fig10_convex&view=");
  const views = await page.$$eval("#view option", (options) => options.map((o) => o.value).filter((v) => v && v !== "machine"));
  assert.ok(views.length >= 10);
  for (const view of views) {
    const before = await watched.worker_seconds();
    const { error, ground } = await page.evaluate(async (name) => {
      const answer = await window.quadrille.call("view", `scene=fig10_convex\nview=${name}`);
      if (answer.error) return { error: answer.error };
      const bytes = new Uint8Array(answer.bytes);
      let ground = 0;
      for (let p = 0; p < bytes.length; p += 4) ground += bytes[p] === 56 && bytes[p + 1] === 56 && bytes[p + 2] === 59;
      return { ground };
    }, view);
    const seconds = (await watched.worker_seconds()) - before;
    assert.equal(error, undefined, view);
    const drawn = 512 * 512 - ground;
    // Tiles are whole, and those around the quad are shown too.
    assert.ok(drawn > 90000 && drawn < (view === "tiles" ? 150000 : 110000), `${view}: ${drawn} pixels`);
    console.log(`${view}: ${seconds.toFixed(2)} s`);
    assert.ok(seconds < 2, `${view}: ${seconds} s`);
  }
  await watched.close();
  assert.deepEqual(problems, []);
});

test("the error stays within the bound, and shows more with fewer bits", async () => {
  const { page, close } = await open(browser, server.address, "#scene=fig10_convex&view=");
  const worst = (bits) =>
    page.evaluate(async (s) => {
      const { result } = await window.quadrille.call("view", `scene=fig10_concave\nsignificand_bits=${s}\nview=error`);
      return { worst: result.worst, bound: result.bound };
    }, bits);
  for (const bits of [10, 18, 24]) {
    const { worst: error, bound } = await worst(bits);
    assert.ok(bound <= 2 ** -(bits - 3) && bound > 2 ** -(bits - 2), `${bits}: ${bound}`);
    assert.ok(error > 2 ** -6 && error < 1, `${bits}: ${error}`);
  }
  await close();
});
