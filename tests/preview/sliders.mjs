// Tests of the sliders of variables.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { tests, until } from "./browser.mjs";

/** Waits until the ball is at this place at the end of the run, after 1 s. */
async function end(page, x) {
  await until(page, (jabuka, x) => jabuka.settled && Math.abs(jabuka.pose("ball", 25)?.location[0] - x) < 1e-9, x);
}

await tests({
  async a_slider_runs_the_scene_again_and_the_file_stays({ open, scene }) {
    const text = readFileSync(scene, "utf8");
    const page = await open();
    await end(page, 1);
    await page.evaluate(() => window.jabuka.seek(25));
    const slider = page.locator("input[name=fast]");
    await slider.focus();
    for (let k = 0; k < 4; k++) await page.keyboard.press("ArrowRight");
    await end(page, 3);
    assert.equal(await page.locator("#sliders output").first().textContent(), "3 m/s");
    assert.equal(await page.evaluate(() => window.jabuka.frame), 25);
    await page.locator("input[name=back]").check();
    await end(page, -3);
    assert.equal(readFileSync(scene, "utf8"), text);
    assert.equal(await slider.inputValue(), "3");
    // A new version of the file has its own values.
    writeFileSync(scene, text.replace("value = 1,", "value = 2,"));
    await end(page, 2);
    assert.equal(await slider.inputValue(), "2");
    assert.equal(await page.locator("input[name=back]").isChecked(), false);
  },

  async without_sliders_there_is_no_place_for_them({ open }) {
    const page = await open();
    assert.equal(await page.locator("#sliders").isVisible(), false);
  },
});
