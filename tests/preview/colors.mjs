// Tests of looks that follow values.

import assert from "node:assert/strict";
import { seek, tests, until } from "./browser.mjs";
import { color, isBlue, isRed, place, projected } from "./picture.mjs";

await tests({
  /** The color follows x, from red at -3 m to blue at 3 m. */
  async bodies_trails_and_ghosts_have_the_colors_of_their_values({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 0);
    assert.ok(isRed(await color(page, await place(page, "ball"))), "the ball at its start");
    await seek(page, 20);
    assert.ok(isBlue(await color(page, await place(page, "ball"))), "the ball at its end");
    const along = (x) => projected(page, [x, 0, 0]).then((spot) => color(page, spot));
    const [first, middle, last] = [await along(-2.4), await along(0.15), await along(2.4)];
    assert.ok(isRed(first), `the trail where it begins: ${first}`);
    assert.ok(isBlue(last), `the trail where it ends: ${last}`);
    assert.ok(Math.abs(middle[0] - middle[2]) < 30 && middle[1] < 30, `the trail in its middle: ${middle}`);
    // The ghosts of a ball that goes the same way, above it, at -3, -0.6 and 1.8 m.
    const ghost = async (x) => color(page, await projected(page, [x, 1.5, 0]));
    const [red, , blue] = [await ghost(-3), await ghost(-0.6), await ghost(1.8)];
    assert.ok(red[0] > red[2] + 60, `the first ghost: ${red}`);
    assert.ok(blue[2] > blue[0] + 60, `the last ghost: ${blue}`);
  },

  async transparency_glow_size_and_visibility_follow_values({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    const at = (place) => projected(page, place).then((spot) => color(page, spot));
    const isWhite = (rgb) => rgb.every((part) => part > 240);
    const frame = async (number) => {
      await seek(page, number);
      const [veil, lamp, beside, hides] = [await at([-3, 0, 0]), await at([0, 0, 0]), await at([3.8, 0, 0]), await at([0, 2, 0])];
      return { veil, lamp, beside, hides };
    };
    const [first, middle, last] = [await frame(0), await frame(10), await frame(20)];
    assert.ok(isRed(first.veil) && first.veil[1] < 10, `opaque: ${first.veil}`);
    assert.ok(middle.veil[0] > 240 && middle.veil[1] > 100 && middle.veil[1] < 160, `half: ${middle.veil}`);
    assert.ok(isWhite(last.veil), `invisible: ${last.veil}`);
    assert.ok(first.lamp[2] < middle.lamp[2] && middle.lamp[2] < last.lamp[2], `${first.lamp} ${middle.lamp} ${last.lamp}`);
    assert.deepEqual(last.lamp, [0, 0, 255], "it shines in its color");
    assert.ok(isWhite(first.beside) && isRed(last.beside), `${first.beside} ${last.beside}`);
    assert.ok(isRed(first.hides) && isWhite(middle.hides) && isWhite(last.hides), `${first.hides} ${middle.hides}`);
  },
});
