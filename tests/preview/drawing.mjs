// Tests of the drawing of frames.

import assert from "node:assert/strict";
import { drawn, LONG, newPage, open, seek, tests, until } from "./browser.mjs";
import { box, color, digest, isBlue, isRed, place } from "./picture.mjs";

await tests({
  async the_first_frame_is_drawn_by_itself({ open }) {
    const page = await open();
    const { frame, frames, bodies, playing, run } = await page.evaluate(() => ({ ...window.jabuka }));
    assert.deepEqual({ frame, frames, bodies, playing }, { frame: 0, frames: 501, bodies: ["ball", "axes"], playing: false });
    assert.equal((await page.evaluate(() => window.jabuka.drawn)).run, run);
    assert.equal(await page.title(), "Parabola – jabuka");
  },

  async the_ball_is_red_the_sky_above_is_blue_and_the_ground_below_is_not({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 250);
    const [{ width, height }, ball] = [await box(page), await place(page, "ball")];
    const [red, sky, ground] = [await color(page, ball), await color(page, [width / 2, 12]), await color(page, [width / 2, height - 12])];
    assert.ok(isRed(red), `the ball is ${red}`);
    assert.ok(isBlue(sky), `the sky is ${sky}`);
    assert.ok(!isBlue(ground) && !isRed(ground), `the ground is ${ground}`);
  },

  async a_ball_that_has_moved_is_drawn_where_it_is_now({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    const before = await place(page, "ball");
    assert.ok(isRed(await color(page, before)), "it is where it begins");
    await seek(page, 250);
    const now = await place(page, "ball");
    assert.ok(Math.hypot(now[0] - before[0], now[1] - before[1]) > 50);
    assert.ok(isRed(await color(page, now)), "it is where it is now");
    assert.ok(!isRed(await color(page, before)), "it is no longer where it was");
  },

  async a_camera_of_ones_own_shows_another_picture_and_the_scenes_the_same_as_before({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 100);
    const before = await digest(page);
    const { x, y, width, height } = await box(page);
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 120, y + height / 2 + 40, { steps: 4 });
    await page.mouse.up();
    const turned = await digest(page);
    assert.notEqual(turned, before);
    assert.ok(isRed(await color(page, await place(page, "ball"))), "the ball is drawn where the camera sees it");
    await page.mouse.wheel(0, 300);
    await drawn(page);
    assert.notEqual(await digest(page), turned, "the wheel goes away");
    await page.locator("#camera").click();
    assert.equal(await digest(page), before);
  },

  async is_drawn_without_a_complaint({ browser, address, keep, close }) {
    for (const each of address.split("\n")) {
      const page = await open(keep(await newPage(browser, { size: { width: 480, height: 420 } })), each);
      const title = await page.title();
      await until(page, (jabuka) => jabuka.settled, null, 4 * LONG);
      const first = await digest(page);
      const middle = await page.evaluate(() => Math.floor(window.jabuka.frames / 2));
      await seek(page, middle);
      const moved = await page.evaluate((middle) => {
        const at = (frame) => JSON.stringify(window.jabuka.bodies.map((_, body) => window.jabuka.pose(body, frame)));
        return at(0) !== at(middle);
      }, middle);
      assert.equal((await digest(page)) !== first, moved, `${title}: what moves is seen to move`);
      assert.equal(await page.evaluate(() => window.jabuka.problem), null, title);
      await close(page);
    }
  },
});
