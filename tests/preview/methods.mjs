// Tests of the choice of another integration method, in place of the scene's or next to it.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { seek, tests, until } from "./browser.mjs";
import { color, projected } from "./picture.mjs";

/** Returns the errors that `jabuka compile` prints for these settings, without the line that counts them. */
function errors(scene, settings) {
  const sets = settings.flatMap((set) => ["--set", `simulation.${set}`]);
  const { status, stderr } = spawnSync(process.env.JABUKA, ["compile", scene, "-o", "compiled", ...sets], { encoding: "utf8" });
  assert.equal(status, 1);
  return stderr.replace(/\n?[^\n]*\d+ errors?\n$/, "").trim();
}

const type = async (page, field, text) => {
  await page.locator(field).fill(text);
  await page.locator(field).press("Enter");
};

await tests({
  async another_method_is_shown_in_place_of_the_scenes_and_the_file_stays({ open, scene }) {
    const text = readFileSync(scene, "utf8");
    const page = await open();
    await page.locator("#integrator").selectOption("rk4");
    await until(page, (jabuka) => jabuka.integrator === "rk4" && jabuka.drawn.run === jabuka.run);
    await seek(page, 100);
    // The exact parabola is 10 t - t² / 2.
    const [, y] = (await page.evaluate(() => window.jabuka.pose("ball"))).location;
    assert.ok(Math.abs(y - 32) < 1e-9, `${y}`);
    await page.locator("#integrator").selectOption("");
    await until(page, (jabuka) => jabuka.integrator === "euler-cromer" && jabuka.drawn.run === jabuka.run);
    await type(page, "#step", "0.02");
    await until(page, (jabuka) => jabuka.pose("ball", 100)?.location[1] < 31.965);
    const [, coarse] = (await page.evaluate(() => window.jabuka.pose("ball"))).location;
    assert.ok(Math.abs(coarse - 31.96) < 1e-9, `${coarse}`);
    assert.equal(readFileSync(scene, "utf8"), text);
  },

  async another_method_is_a_ghost_beside_the_scenes_with_its_distance({ open, scene }) {
    const text = readFileSync(scene, "utf8");
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 250);
    // With steps of h, one method is a t h / 2 too low and the other equally too high: 20 m/s² · 10 s · 0.04 s = 8 m apart.
    const [a, t, h] = [20, 10, 0.04];
    const [place, here] = [0, a * t * h].map((far) => [0, -0.5 * a * t * (t + h) + far, 0]);
    const spot = await projected(page, here);
    const before = await color(page, spot);
    await page.locator("#other-integrator").selectOption("explicit-euler");
    await until(page, (jabuka) => jabuka.comparison.includes("apart"));
    assert.equal(await page.evaluate(() => window.jabuka.comparison), "explicit-euler as a ghost: 8 m apart (ball)");
    const own = (await page.evaluate(() => window.jabuka.pose("ball"))).location;
    assert.ok(Math.abs(own[1] - place[1]) < 1e-6, "the scene's own run stays");
    const ghost = await color(page, spot);
    assert.ok(ghost.some((c, i) => Math.abs(c - before[i]) > 25), `${before} → ${ghost}`);
    await type(page, "#other-step", "0.02");
    await until(page, (jabuka) => jabuka.comparison.includes("6 m apart"));
    await page.locator("#other-integrator").selectOption("");
    await until(page, (jabuka) => jabuka.comparison === "");
    assert.deepEqual(await color(page, spot), before);
    assert.equal(readFileSync(scene, "utf8"), text);
  },

  async a_step_that_is_none_is_said_as_in_the_terminal_and_changes_nothing({ open, scene }) {
    // Browsers write every error status of an answer to their console.
    const page = await open({ may: [/422/] });
    const text = readFileSync(scene, "utf8");
    await seek(page, 100);
    const before = await page.evaluate(() => [window.jabuka.run, window.jabuka.pose("ball")]);
    const problem = page.locator("#method-problem");
    for (const step of ["-1", "abc"]) {
      await type(page, "#step", step);
      await problem.waitFor();
      const expected = errors(scene, ["integrator=euler-cromer", `step=${step}`]);
      await page.waitForFunction((text) => document.getElementById("method-problem").textContent.trim() === text, expected);
      assert.match(expected, /step/);
      assert.deepEqual(await page.evaluate(() => [window.jabuka.run, window.jabuka.pose("ball")]), before);
    }
    await type(page, "#step", "");
    await problem.waitFor({ state: "hidden" });
    await page.locator("#other-integrator").selectOption("rk4");
    await type(page, "#other-step", "-1");
    await problem.waitFor();
    assert.deepEqual(await page.evaluate(() => [window.jabuka.run, window.jabuka.comparison]), [before[0], ""]);
    assert.equal(readFileSync(scene, "utf8"), text);
  },
});
