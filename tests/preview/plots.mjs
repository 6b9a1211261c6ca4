// Tests of the plots of a scene, over the picture.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { seek, tests, until } from "./browser.mjs";

/** Returns the curves and dots of the plots, in CSS pixels, and the texts. */
const shown = (page) => page.evaluate(() => {
  const points = (line) => line.getAttribute("points").split(" ").map((point) => point.split(",").map(Number));
  const { width } = document.getElementById("texts").getBoundingClientRect();
  return {
    width,
    panels: [...document.querySelectorAll(".plots rect")].map((box) => ["x", "y", "width", "height"].map((key) => Number(box.getAttribute(key)))),
    curves: [...document.querySelectorAll(".plots polyline")].map(points),
    dots: [...document.querySelectorAll(".plots circle")].map((dot) => [Number(dot.getAttribute("cx")), Number(dot.getAttribute("cy"))]),
    texts: [...document.querySelectorAll("#texts span")].map((span) => span.textContent),
  };
});

await tests({
  async the_plots_of_a_scene_are_drawn_as_far_as_time_has_come({ open, scene }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 60);
    const early = await shown(page);
    await seek(page, 130);
    const late = await shown(page);
    assert.equal(late.panels.length, 2);
    assert.equal(late.curves.length, 4);
    for (const [k, curve] of late.curves.entries()) {
      assert.ok(curve.length > early.curves[k].length, `curve ${k} grows`);
      assert.deepEqual(curve.at(-1), late.dots[k], `a dot stands at the end of curve ${k}`);
    }
    for (const word of ["Energy", "kinetic", "potential", "total", "J", "t (s)"]) assert.ok(late.texts.includes(word), word);
    // The script of the same frame places the dots at the same positions of the picture.
    const { status, stderr } = spawnSync(process.env.JABUKA, ["compile", scene, "-o", "compiled", "--frames", "130"], { encoding: "utf8" });
    assert.equal(status, 0, stderr);
    const script = readFileSync("compiled/frame_0130.pov", "utf8");
    const number = "(-?[\\d.e-]+)";
    const calls = script.matchAll(new RegExp(`Dot\\(<${number}, [^>]*>, <${number}, ${number}, 0>`, "g"));
    const places = [...calls].map((call) => call.slice(1).map(Number));
    assert.equal(places.length, 4);
    for (const [k, [left, x, y]] of places.entries()) {
      const panel = late.panels[k < 3 ? 0 : 1];
      // The picture is twice as wide as a unit of the image plane, and the panel lies at `left`.
      const unit = panel[2] / 0.72;
      const expected = [panel[0] + unit * x, panel[1] + panel[3] - unit * y];
      assert.ok(Math.hypot(late.dots[k][0] - expected[0], late.dots[k][1] - expected[1]) < 1, `dot ${k}: ${late.dots[k]}, not ${expected}`);
      assert.ok(Math.abs(left - 0.245) < 1e-3);
    }
  },

  async bars_are_as_high_as_the_values_of_the_moment({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    const bars = () => page.evaluate(() => [...document.querySelectorAll(".plots rect.bar")].map((bar) => {
      const [x, y, width, height] = ["x", "y", "width", "height"].map((key) => Number(bar.getAttribute(key)));
      return { x, y, width, height, fill: bar.getAttribute("fill"), plot: bar.parentNode.dataset.plot };
    }));
    await seek(page, 50);
    const [half, below] = await bars();
    await seek(page, 100);
    const [up, down, ...bins] = await bars();
    assert.ok(Math.abs(up.height / half.height - 2) < 0.01 && Math.abs(up.height / down.height - 2) < 0.01, `${up.height} ${half.height} ${down.height}`);
    const zero = up.y + up.height;
    assert.ok(Math.abs(zero - down.y) < 0.1 && Math.abs(zero - below.y) < 0.1 && Math.abs(zero - half.y - half.height) < 0.1, "they begin at one line");
    assert.ok(up.fill !== down.fill && up.x + up.width < down.x);
    // 12 copies at 0, 1, … 11: four of them are in each of three bins.
    assert.deepEqual(bins.map((bin) => bin.plot), ["spread", "spread", "spread"]);
    for (const bin of bins) assert.ok(Math.abs(bin.height - bins[0].height) < 0.01 && bin.height > 10, `${bin.height}`);
  },

  async labels_have_subscripts_lines_and_times({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    const labels = () => page.evaluate(() => [...document.querySelectorAll("#texts span")].map((span) => span.textContent));
    await seek(page, 0);
    assert.deepEqual(await labels(), ["xmax = 0,0\nm/s²", "at the start"]);
    const [whole, small, size] = await page.evaluate(() => {
      const span = document.querySelector("#texts span");
      const box = (element) => element.getBoundingClientRect().toJSON();
      return [box(span), box(span.querySelector("small")), parseFloat(span.style.fontSize)];
    });
    assert.ok(Math.abs(whole.height - 2.3 * size) < 1, `two lines: ${whole.height}, letters of ${size}`);
    assert.ok(small.left > whole.left + 0.5 * size && small.right < whole.left + 2.5 * size, "the subscript stands behind the x");
    assert.ok(small.height < 0.9 * size && small.bottom < whole.bottom, "it has smaller letters, in the first line");
    await seek(page, 20);
    assert.deepEqual(await labels(), ["xmax = 0,8\nm/s²"]);
  },
  async labels_have_bold_letters_and_fonts_of_their_own({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await until(page, () => document.querySelectorAll("#texts span").length === 2);
    const { fonts, family, raised, bold, weights } = await page.evaluate(() => {
      const [own, other] = document.querySelectorAll("#texts span");
      return {
        fonts: [...document.fonts].filter((font) => font.status === "loaded").map((font) => font.family),
        family: getComputedStyle(own).fontFamily,
        raised: [...own.querySelectorAll("small")].map((part) => part.textContent),
        bold: [...other.querySelectorAll("b")].map((part) => part.textContent),
        weights: [...other.querySelectorAll("b, small")].map((part) => getComputedStyle(part).fontWeight),
      };
    });
    const own = fonts.find((name) => name.startsWith("label "));
    assert.ok(own && family.includes(own), `${fonts}: ${family}`);
    assert.deepEqual(raised, ["−6"], "the font has no letters for superscripts");
    assert.deepEqual(bold, ["Bold", "0.0"]);
    assert.deepEqual(weights, ["700", "700", "400"]);
  },
});
