// Tests of playing the film: going back to the beginning, stepping from frame to frame, and the same poses each time.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { drawn, poses, seek, tests, until } from "./browser.mjs";

const atStart = async (page, after) => {
  const { frame, playing } = await page.evaluate(() => ({ ...window.jabuka }));
  assert.deepEqual({ frame, playing }, { frame: 0, playing: false }, `after ${after}`);
};

/** Presses the space bar, and waits until a focused button would have reacted to the release of the key. */
const space = async (page) => {
  await page.keyboard.press("Space");
  await drawn(page);
};

await tests({
  async the_space_key_goes_back_to_the_initial_state({ open }) {
    const page = await open();
    await page.evaluate(() => window.jabuka.play());
    await until(page, (jabuka) => jabuka.playing && jabuka.frame > 3);
    await space(page);
    await atStart(page, "playing");
    for (const place of ["#forward", "#play", "#reset", "#camera", "#help", "#speed", "#integrator", "#plotted", "#time", "#step", "#other-step", "#loop", "#plot", "#plot-csv", "#picture"]) {
      await seek(page, 77);
      await page.locator(place).focus();
      await space(page);
      await atStart(page, place);
      assert.equal(await page.evaluate(() => document.querySelector("dialog").open), false, place);
    }
    assert.equal(await page.locator("#step").inputValue(), "", "no space is written");
    assert.equal(await page.locator("#loop").isChecked(), false, "nothing else is done");
  },

  async the_reset_button_does_the_same({ open }) {
    const page = await open();
    await page.evaluate(() => window.jabuka.play());
    await until(page, (jabuka) => jabuka.playing && jabuka.frame > 0);
    await page.locator("#reset").click();
    await atStart(page, "the button");
  },

  async played_again_every_pose_is_what_it_was({ open, scene }) {
    const page = await open();
    const first = await poses(page);
    const run = await page.evaluate(() => window.jabuka.run);
    await page.evaluate(() => window.jabuka.play());
    await until(page, (jabuka) => jabuka.frame > 3);
    await space(page);
    assert.equal(await poses(page), first, "after a reset");
    await page.evaluate(() => window.jabuka.play());
    await until(page, (jabuka) => jabuka.frame > 3);
    assert.equal(await poses(page), first, "while it is played again");
    // The server simulates the scene again after it has served another one.
    const text = readFileSync(scene, "utf8");
    writeFileSync(scene, text.replace("velocity = [2.0, 10.0", "velocity = [3.0, 10.0"));
    await until(page, (jabuka, run) => jabuka.run !== run, run);
    const other = await page.evaluate(() => window.jabuka.run);
    assert.notEqual(await poses(page), first);
    writeFileSync(scene, `# A comment changes nothing.\n${text}`);
    await until(page, (jabuka, other) => jabuka.run !== other, other);
    assert.notEqual(await page.evaluate(() => window.jabuka.run), run);
    assert.equal(await poses(page), first, "simulated once more");
  },

  async keys_and_buttons_step_from_frame_to_frame({ open }) {
    const page = await open();
    const steps = [["ArrowRight", 1], ["ArrowRight", 2], ["Shift+ArrowRight", 12], ["ArrowLeft", 11], ["Shift+ArrowLeft", 1], ["End", 500], ["ArrowRight", 500], ["Home", 0], ["ArrowLeft", 0]];
    for (const [key, frame] of steps) {
      await page.keyboard.press(key);
      assert.equal(await drawn(page), frame, key);
    }
    for (const [button, frame] of [["#forward", 1], ["#forward", 2], ["#back", 1]]) {
      await page.locator(button).click();
      assert.equal(await drawn(page), frame, button);
    }
    assert.match(await page.locator("#clock").innerText(), /^0\.04 s, frame 1 of 500$/);
    await page.keyboard.press("p");
    await until(page, (jabuka) => jabuka.playing);
    await page.keyboard.press("p");
    assert.equal(await page.evaluate(() => window.jabuka.playing), false);
  },

  async the_slider_scrubs_by_keyboard_and_by_mouse({ open }) {
    const page = await open();
    const slider = page.locator("#time");
    await slider.focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await drawn(page), 1);
    await page.keyboard.press("PageUp");
    assert.ok((await drawn(page)) > 10, "a page is more than a step");
    const { x, y, width, height } = await slider.boundingBox();
    await page.mouse.move(x + width / 4, y + height / 2);
    await page.mouse.down();
    const quarter = await drawn(page);
    assert.ok(Math.abs(quarter - 125) < 12, `${quarter}`);
    await page.mouse.move(x + (width * 3) / 4, y + height / 2, { steps: 5 });
    await page.mouse.up();
    const three = await drawn(page);
    assert.ok(Math.abs(three - 375) < 12, `${three}`);
    assert.equal((await page.evaluate(() => window.jabuka.drawn)).frame, three);
  },

  async a_click_in_the_plot_goes_to_that_time({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    for (const part of [0.5, 0.9]) {
      const { x, y } = await page.locator("#plot").boundingBox();
      const { left, top, width, height } = await page.evaluate(() => window.jabuka.plot.area);
      await page.mouse.click(x + left + part * width, y + top + height / 2);
      const frame = await drawn(page);
      assert.ok(Math.abs(frame - 500 * part) <= 500 / width + 1, `${frame} at ${part}`);
      assert.equal(await page.evaluate(() => window.jabuka.playing), false);
    }
  },
});
