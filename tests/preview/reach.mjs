// Tests that all controls can be reached on a phone and without a mouse.

import assert from "node:assert/strict";
import { seek, tests, until } from "./browser.mjs";
import { box, place } from "./picture.mjs";

const PHONE = { size: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 };
const CONTROLS = ["camera", "render", "help", "body-name", "integrator", "step", "other-integrator", "other-step", "reset", "back", "play", "forward", "time", "speed", "loop", "plotted", "plot-csv", "plot-svg", "plot-enlarge"];

await tests({
  async all_controls_are_in_reach_on_a_phone({ open }) {
    const page = await open(PHONE);
    await until(page, (jabuka) => jabuka.settled);
    const wide = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    assert.deepEqual(wide, [390, 390], "nothing is beside the screen");
    const { width, height } = await box(page);
    assert.ok(width > 380 && height > 250, `the picture is ${width} x ${height}`);
    for (const id of [...CONTROLS, "plot"]) {
      const control = page.locator(`#${id}`);
      await control.scrollIntoViewIfNeeded();
      const at = await control.boundingBox();
      assert.ok(at && at.x >= 0 && at.x + at.width <= 390.5 && at.y >= 0 && at.y + at.height <= 844.5, `${id}: ${JSON.stringify(at)}`);
      // A click would hit this control, not an element above it.
      await control.click({ trial: true });
    }
    await page.locator("#forward").tap();
    assert.equal(await page.evaluate(() => window.jabuka.frame), 1);
    await seek(page, 250);
    const [left, top] = await place(page, "ball");
    const canvas = await box(page);
    await page.touchscreen.tap(canvas.x + left, canvas.y + top);
    await until(page, (jabuka) => jabuka.selected === "ball");
  },

  async the_tab_key_reaches_all_controls_and_shows_where_it_is({ open }) {
    const page = await open();
    const reached = [];
    for (let n = 0; n < 40; n++) {
      await page.keyboard.press("Tab");
      const [id, outline] = await page.evaluate(() => {
        const { id } = document.activeElement;
        const style = getComputedStyle(document.activeElement);
        return [id, style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 0];
      });
      if (reached.includes(id)) break;
      if (id) assert.ok(outline, `the focus on ${id} is not to be seen`);
      reached.push(id);
    }
    const missing = ["picture", ...CONTROLS, "plot"].filter((id) => !reached.includes(id));
    assert.deepEqual(missing, [], `of ${reached}`);
  },

  async keys_do_what_a_mouse_does({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    const view = () => page.evaluate(async () => (await window.jabuka.whenDrawn(), window.jabuka.view.clip.join()));
    let before = await view();
    for (const key of ["a", "w", "d", "d", "s", "s", "e", "q", "q"]) {
      await page.keyboard.press(key);
      const now = await view();
      assert.notEqual(now, before, key);
      before = now;
    }
    await page.keyboard.press("n");
    assert.equal(await page.evaluate(() => window.jabuka.selected), "ball");
    await page.keyboard.press("b");
    assert.equal(await page.evaluate(() => window.jabuka.selected), "axes");
    await page.keyboard.press("+");
    assert.equal(await page.locator("#speed").inputValue(), "2");
    await page.keyboard.press("?");
    assert.ok(await page.locator("#keys").isVisible());
    await page.keyboard.press("Escape");
    assert.ok(await page.locator("#keys").isHidden());
  },
});
