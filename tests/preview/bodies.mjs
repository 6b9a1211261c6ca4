// Tests of the bodies' poses, and of the panel with the values of the selected body.

import assert from "node:assert/strict";
import { poses, seek, tests, until } from "./browser.mjs";
import { box, click, color, isRed, place, projected } from "./picture.mjs";

/** Waits until the panel shows the values at a time, and returns its rows. */
async function values(page, time) {
  await page.waitForFunction((time) => document.getElementById("body-values").innerText.includes(`time\t${time}`), `${time} s`);
  const rows = await page.locator("#body-values tr").evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.innerText)));
  return Object.fromEntries(rows);
}

await tests({
  /** Prints all poses; the Rust test compares them with the scripts. */
  async poses({ open }) {
    const page = await open();
    const all = JSON.parse(await poses(page));
    const names = await page.evaluate(() => window.jabuka.bodies);
    process.stdout.write(JSON.stringify({ names, frames: all }));
  },

  async a_click_on_a_body_shows_its_values_at_that_time({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 100);
    await click(page, await place(page, "ball"));
    assert.equal(await page.evaluate(() => window.jabuka.selected), "ball");
    assert.equal(await page.locator("#body-name").inputValue(), "ball");
    // x = 20 + 2 t. The method has an error of half a step: y = 10 t - t (t + 0.01 s) / 2.
    const then = await values(page, 4);
    assert.equal(then.location, "28, 31.98, 0 m");
    assert.equal(then.velocity, "2, 6, 0 m/s");
    assert.equal(then["kinetic energy"], "20 J");
    assert.equal(then.mass, "1 kg");
    await seek(page, 200);
    assert.equal((await values(page, 8)).velocity, "2, 2, 0 m/s", "the values go with the time");
  },

  async contacts_are_shown_with_their_forces({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await page.locator("#body-name").fill("crate");
    await page.keyboard.press("Enter");
    await seek(page, 20);
    // The ground holds its weight and that of the ball on it, and the force that pulls it.
    await page.locator("#body-values", { hasText: "the ground, 100 N, friction 10 N" }).waitFor();
    assert.match(await page.locator("#body-values").innerText(), /ball, 20 N/);
    const lookAt = () => seek(page, 20).then(() => projected(page, [0.05, 0.3, 0])).then((spot) => color(page, spot));
    const isGreen = ([red, green, blue]) => green > 1.5 * red && green > 1.2 * blue;
    assert.ok(!isGreen(await lookAt()));
    // The force pulls at a height of 0.5 m, so the center of pressure is 10 N · 0.5 m / 100 N to the right. There begins the arrow, in front of the crate.
    await page.locator("#show-contacts").check();
    const limit = Date.now() + 20_000;
    while (!isGreen(await lookAt())) assert.ok(Date.now() < limit, "there is no arrow");
    await page.locator("#show-contacts").uncheck();
    assert.ok(!isGreen(await lookAt()));
  },

  async a_body_is_seen_while_it_is_there({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await page.locator("#body-name").fill("comes");
    await page.keyboard.press("Enter");
    await until(page, (jabuka) => jabuka.selected === "comes");
    for (const [frame, there, y] of [[0, false, 0], [3, false, 0], [4, true, 0], [8, true, 1], [9, false, 1], [12, false, 1]]) {
      await seek(page, frame);
      assert.ok(isRed(await color(page, await place(page, "stays"))), `the other ball in frame ${frame}`);
      // Look next to the trail, which stays visible.
      const spot = await projected(page, [2.6, y, 0]);
      assert.equal(isRed(await color(page, spot)), there, `frame ${frame}`);
      const rows = await values(page, frame / 4);
      assert.equal(rows.now, there ? undefined : "not there", `frame ${frame}`);
    }
  },

  async a_particle_is_seen_while_it_lives({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    assert.equal(await page.evaluate(() => window.jabuka.problem), null);
    for (const [frame, there] of [[0, false], [3, false], [4, true], [8, true], [9, false], [12, false], [6, true]]) {
      await seek(page, frame);
      const spot = await projected(page, [2, frame / 4 - 0.9, 0]);
      assert.equal(isRed(await color(page, spot)), there, `frame ${frame}`);
    }
  },

  async a_click_beside_all_bodies_chooses_none_and_names_can_be_typed({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await click(page, await place(page, "ball"));
    assert.equal(await page.evaluate(() => window.jabuka.selected), "ball");
    await click(page, [(await box(page)).width / 2, 8]);
    assert.equal(await page.evaluate(() => window.jabuka.selected), null);
    await page.locator("#body-name").fill("axes");
    await page.keyboard.press("Enter");
    await until(page, (jabuka) => jabuka.selected === "axes");
    assert.equal((await values(page, 0)).velocity, "0, 1, 0 m/s");
  },
});
