// Tests of the viewer's own camera as a camera of the scene.

import assert from "node:assert/strict";
import { appendFileSync } from "node:fs";
import { drawn, tests, until } from "./browser.mjs";
import { box, place } from "./picture.mjs";

await tests({
  async the_viewers_camera_becomes_that_of_the_scene({ open, scene }) {
    for (const size of [{ width: 900, height: 640 }, { width: 1300, height: 480 }]) {
      const page = await open({ size });
      await until(page, (jabuka) => jabuka.settled);
      assert.equal(await page.locator("#copy-camera").isVisible(), false);
      for (const key of ["a", "a", "w", "q", "e", "e"]) await page.keyboard.press(key);
      const names = await page.evaluate(() => window.jabuka.bodies);
      const places = async () => {
        await drawn(page);
        const { width, height } = await box(page);
        return Promise.all(names.map(async (name) => (await place(page, name)).map((c, k) => c - [width, height][k] / 2)));
      };
      const own = await places();
      await page.locator("#copy-camera").click();
      const text = await page.locator("#camera-text").textContent();
      assert.match(text, /^\[camera\]\nlocation = \[.*\]\nlook_at = \[.*\]\nangle = [\d.]+\n$/);
      await page.locator("#camera-dialog button").click();
      const run = await page.evaluate(() => window.jabuka.run);
      appendFileSync(scene, text.replace("[camera]", `[view.v${size.width}]`));
      await until(page, (jabuka, run) => jabuka.run !== run && jabuka.settled && jabuka.drawn.run === jabuka.run, run);
      await page.keyboard.press("c");
      await page.locator("#view").selectOption({ label: `v${size.width}` });
      const copied = await places();
      // The picture of the scene has a margin of 2 % on each side.
      const apart = copied.flatMap((point, i) => point.map((c, k) => Math.abs(c - 0.96 * own[i][k])));
      assert.ok(Math.max(...apart) < 0.05, JSON.stringify([own, copied]));
    }
  },
});
