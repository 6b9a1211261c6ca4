// Tests with ten thousand bodies, and with a run that does not end.

import assert from "node:assert/strict";
import { drawn, LONG, seek, tests, until } from "./browser.mjs";

await tests({
  async what_is_shown_beside_bodies_does_not_hold_up_a_run_that_goes_on({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.recorded > 1);
    await seek(page, 1);
    assert.equal(await page.evaluate(() => window.jabuka.settled), false);
  },

  async the_page_works_while_the_run_goes_on({ open }) {
    const page = await open({ size: { width: 480, height: 400 } });
    const { recorded, frames, settled } = await page.evaluate(() => ({ ...window.jabuka }));
    assert.ok(recorded < frames && !settled, `drawn when ${recorded} of ${frames} were there`);
    await until(page, (jabuka) => jabuka.recorded > 20);
    await seek(page, 10);
    const { location } = await page.evaluate(() => window.jabuka.pose(9999));
    // This is the last body of a grid of 100 by 100, and it falls.
    assert.ok(location[0] === 99 && location[1] < 99 && location[1] > 98, `${location}`);
    await until(page, (jabuka) => jabuka.settled, null, 3 * LONG);
    await seek(page, 999);
    assert.equal((await page.evaluate(() => window.jabuka.drawn)).frame, 999);
    await page.keyboard.press("Space");
    assert.equal(await drawn(page), 0);
  },
});
