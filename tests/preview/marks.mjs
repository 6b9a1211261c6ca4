// Tests of angles, dimension lines and names of arrows, over the picture.

import assert from "node:assert/strict";
import { drawn, seek, tests, until } from "./browser.mjs";
import { box, place } from "./picture.mjs";

/** Returns the middle of the text with these words, or nothing. */
const text = (page, words) => page.evaluate((words) => {
  const span = [...document.querySelectorAll("#texts span")].find((each) => each.textContent === words);
  const { x, y, width, height } = span?.getBoundingClientRect() ?? {};
  return span && [x + width / 2, y + height / 2];
}, words);

await tests({
  async texts_stay_at_their_marks_from_every_viewpoint({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 0);
    const ways = async () => {
      const ball = await place(page, "ball");
      const way = async (words) => {
        const at = await text(page, words);
        assert.ok(at, `${words} is shown`);
        return Math.hypot(at[0] - ball[0], at[1] - ball[1]);
      };
      return [ball, await way("α"), await way("v")];
    };
    const [first, ...before] = await ways();
    const { x, y, width, height } = await box(page);
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 60, y + height / 2 + 30, { steps: 4 });
    await page.mouse.up();
    await drawn(page);
    const [second, ...after] = await ways();
    assert.ok(Math.hypot(second[0] - first[0], second[1] - first[1]) > 10, "the ball is seen elsewhere");
    for (const [k, way] of after.entries()) assert.ok(Math.abs(way - before[k]) < 0.5 * before[k], `${way} px, not about ${before[k]}`);
  },
});
