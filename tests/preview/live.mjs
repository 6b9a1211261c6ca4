// Tests that the page follows changes of the scene's files.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, renameSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { drawn, newPage, seek, tests, until } from "./browser.mjs";
import { color, isRed, place } from "./picture.mjs";

const state = (page) => page.evaluate(() => ({ ...window.jabuka }));

/** Replaces a part of a file's text. */
function edit(file, piece, by) {
  const text = readFileSync(file, "utf8");
  assert.ok(text.includes(piece), `${file} has ${piece}`);
  writeFileSync(file, text.replace(piece, by));
}

/** Waits until a run other than this one is drawn, and returns its number. */
async function another(page, run) {
  await until(page, (jabuka, run) => jabuka.run !== run && jabuka.drawn.run === jabuka.run, run);
  return (await state(page)).run;
}

/** Returns the errors that `jabuka check` prints for a scene, without the line that counts them. */
function errors(scene) {
  const { status, stderr } = spawnSync(process.env.JABUKA, ["check", scene], { encoding: "utf8" });
  assert.equal(status, 1);
  return stderr.replace(/\n?[^\n]*\d+ errors?\n$/, "").trim();
}

/** Waits until the page shows the errors that `jabuka check` prints. */
async function wrong(page, scene) {
  await until(page, (jabuka) => jabuka.problem);
  const text = errors(scene);
  await until(page, (jabuka, text) => jabuka.problem?.trim() === text, text);
  assert.ok(await page.locator("#problem").isVisible());
  return text;
}

const mended = (page) => until(page, (jabuka) => jabuka.problem === null && jabuka.run);
const x = (page, body = "ball") => page.evaluate((body) => window.jabuka.pose(body)?.location[0], body);

/** Ten scenes that differ in all that the page shows: camera, labels, bodies, ghosts, particles, trails, warnings and errors. */
const BALL = "[body.ball]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n";
const SCENES = [
  `title = 'Labelled'\n${BALL}[label.one]\ntext = 'one \${t}'\n[camera]\nlocation = [9, 9, 9]\nlook_at = [1, 0, 0]\n`,
  `title = 'Bare'\n${BALL}`,
  `title = 'Two'\n${BALL}[body.box]\nshape.box.size = [1, 2, 1]\nlocation = [0, 5, 0]\narrows.velocity.scale = 1\n[label.two]\ntext = 'two'\nbody = 'ball'\n`,
  `title = 'Flat'\n${BALL}[camera]\nprojection = 'orthographic'\nwidth = 12\nlocation = [0, 0, 20]\nlook_at = [0, 0, 0]\n`,
  `title = 'Ghosts'\n${BALL}[body.other]\nshape.sphere.radius = 0.5\nvelocity = [0, 2, 0]\nghosts.every = 0.2\n`,
  `title = 'Follow'\n${BALL}[camera]\nfollow.body = 'ball'\n[label.speed]\ntext = '\${ball.speed}'\n`,
  `title = 'Wrong'\n${BALL}mass = -1\n`,
  `title = 'Drops'\n${BALL}[emitter.drops]\nrate = 20\nlifetime = 0.5\nspeed = 3\nshape.sphere.radius = 0.1\nfrom.point = [0, 2, 0]\n[label.drops]\ntext = 'drops'\n`,
  `title = 'Trail'\n${BALL}trail = true\n[view.side]\nlocation = [20, 0, 0]\nlook_at = [0, 0, 0]\n`,
  `title = 'Last'\n[body.last]\nshape.sphere.radius = 2\nvelocity = [0, 1, 0]\n[camera]\nlocation = [3, 2, 30]\nlook_at = [0, 1, 0]\n`,
];
const timed = (text) => `${text.split("\n")[0]}\nsimulation.duration = 1\n${text.split("\n").slice(1).join("\n")}`;

/** Returns everything that a page shows of its scene, apart from the pixels of the picture. */
const everything = (page) => page.evaluate(() => {
  const text = (id) => document.getElementById(id).textContent;
  const { view, drawn, bodies, frames, frame, problem, settled } = window.jabuka;
  const labels = [...document.querySelectorAll("#texts span")].map((span) => [span.textContent, span.style.cssText]);
  const others = ["title", "clock", "status", "legend", "drift", "problem", "comparison", "view"].map(text);
  return { clip: view.clip, size: view.size, center: view.center, frame: drawn.frame, same: drawn.run === window.jabuka.run,
    bodies, frames, at: frame, problem, settled, labels, others, plot: document.getElementById("plot").toDataURL() };
});

/** Waits until a page shows the same as one that is opened anew, and compares the two, also pixel by pixel. */
async function asOpenedAnew(page, open, last) {
  await until(page, (jabuka, last) => jabuka.settled && document.title.startsWith(last), last);
  const anew = await open();
  await until(anew, (jabuka) => jabuka.settled);
  for (const each of [page, anew]) await seek(each, 3);
  const begun = Date.now();
  for (;;) {
    const [one, two] = [await everything(page), await everything(anew)];
    const [pixels, expected] = [await page.locator("#picture").screenshot(), await anew.locator("#picture").screenshot()];
    if (JSON.stringify(one) === JSON.stringify(two) && pixels.equals(expected)) break;
    if (Date.now() - begun > 20_000) {
      assert.deepEqual(one, two);
      assert.fail("the pixels differ");
    }
    await page.waitForTimeout(50);
  }
  await anew.context().close();
}

await tests({
  async after_ten_scenes_that_are_shown_each_the_page_shows_the_last({ open, scene }) {
    const page = await open();
    for (const text of SCENES) {
      await page.evaluate(() => window.jabuka.play());
      writeFileSync(scene, timed(text));
      if (text.includes("mass = -1")) {
        await wrong(page, scene);
        continue;
      }
      const title = text.split("'")[1];
      await until(page, (jabuka, title) => jabuka.settled && document.title.startsWith(title) && jabuka.drawn.run === jabuka.run, title);
      assert.equal((await state(page)).problem, null);
      const labels = await page.evaluate(() => [...document.querySelectorAll("#texts span:not(.axis)")].map((span) => span.textContent));
      // No label of a scene before is left. The present one may be missing until it is fetched.
      const own = { Labelled: /^one /, Two: /^two$/, Follow: /^1/, Drops: /^drops$/ }[title] ?? /^$/;
      assert.ok(labels.every((label) => own.test(label)), `${title}: ${labels}`);
      if (title === "Two") await asOpenedAnew(page, open, title);
    }
    await asOpenedAnew(page, open, "Last");
  },

  async after_ten_scenes_that_are_saved_at_once_the_page_shows_the_last({ open, scene }) {
    const page = await open();
    for (const pause of [15, 80]) {
      const { run } = await state(page);
      await page.evaluate(() => window.jabuka.play());
      for (const text of SCENES) {
        writeFileSync(scene, timed(text).replace("radius = 2", `radius = 2.${pause}`));
        await page.waitForTimeout(pause);
      }
      await until(page, (jabuka, run) => jabuka.run !== run && document.title.startsWith("Last"), run);
      await asOpenedAnew(page, open, "Last");
    }
  },

  async a_change_that_is_saved_is_shown_at_the_same_time_without_a_reload({ open, scene }) {
    const page = await open();
    const { run } = await state(page);
    await page.evaluate(() => (window.before = true));
    await seek(page, 100);
    edit(scene, "velocity = [2.0, 10.0", "velocity = [3.0, 10.0");
    await another(page, run);
    assert.equal(await drawn(page), 100);
    assert.ok(Math.abs((await x(page)) - 32) < 1e-9, "20 + 3 t");
    assert.equal(await page.evaluate(() => window.before), true);
    await until(page, (jabuka) => jabuka.settled);
    assert.ok(isRed(await color(page, await place(page, "ball"))));
    // Save as some editors do: write another file, and rename it.
    const { run: second } = await state(page);
    writeFileSync(`${scene}~`, readFileSync(scene, "utf8").replace("velocity = [3.0", "velocity = [4.0"));
    renameSync(`${scene}~`, scene);
    await another(page, second);
    assert.ok(Math.abs((await x(page)) - 36) < 1e-9);
  },

  async a_mistake_is_shown_as_in_the_terminal_and_the_last_good_run_stays({ open, scene }) {
    const page = await open();
    const { run } = await state(page);
    await seek(page, 50);
    edit(scene, "mass = 1.0", "mass = -1.0");
    const text = await wrong(page, scene);
    const line = readFileSync(scene, "utf8").split("\n").findIndex((text) => text.startsWith("mass")) + 1;
    assert.ok(text.includes(`${scene}:${line}:8`), text);
    assert.equal((await state(page)).run, run);
    await seek(page, 400);
    edit(scene, "mass = -1.0", "mass = = 1.0");
    const syntax = await wrong(page, scene);
    assert.notEqual(syntax, text);
    edit(scene, "mass = = 1.0", "mass = 1.0");
    await mended(page);
    assert.ok(await page.locator("#problem").isHidden());
    assert.equal((await state(page)).frame, 400);
    process.stdout.write(`${text}\n${syntax}`);
  },

  async files_that_a_scene_takes_in_count_as_well({ open, scene }) {
    const page = await open();
    let { run } = await state(page);
    await seek(page, 20);
    edit(join(dirname(scene), "parts/ball.toml"), "velocity = [1", "velocity = [2");
    run = await another(page, run);
    assert.equal((await state(page)).frame, 20);
    assert.ok(Math.abs((await x(page)) - 2 * 0.8) < 1e-9);
    // Scale the mesh of the ring to half its size.
    const mesh = join(dirname(scene), "meshes/twisted_ring.obj");
    const halved = readFileSync(mesh, "utf8").replace(/^v (\S+) (\S+) (\S+)/gm, (_, ...v) => `v ${v.slice(0, 3).map((c) => c / 2).join(" ")}`);
    writeFileSync(mesh, halved);
    run = await another(page, run);
    writeFileSync(mesh, "v 1 2\n");
    await wrong(page, scene);
    writeFileSync(mesh, halved.replace(/^v (\S+)/m, "v 0.001"));
    await another(page, run);
    await mended(page);
  },

  async a_file_that_is_not_there_yet_is_waited_for({ browser, address, scene, keep }) {
    const page = keep(await newPage(browser));
    await page.goto(address);
    const later = join(dirname(scene), "later.toml");
    assert.ok(!existsSync(later));
    const text = await wrong(page, scene);
    assert.match(text, /later\.toml/);
    assert.ok(await page.locator("#nothing").isVisible());
    writeFileSync(later, "[body.ball]\nshape.sphere.radius = 1\n");
    await until(page, (jabuka) => jabuka.drawn.count > 0);
    await mended(page);
    assert.deepEqual((await state(page)).bodies, ["ball"]);
    assert.ok(await page.locator("#nothing").isHidden());
  },

  async a_scene_with_errors_is_shown_once_they_are_mended({ browser, address, scene, keep }) {
    const page = keep(await newPage(browser));
    await page.goto(address);
    await wrong(page, scene);
    edit(scene, "radius = -1", "radius = 1");
    await until(page, (jabuka) => jabuka.drawn.count > 0 && jabuka.problem === null);
  },

  async a_scene_may_change_while_the_page_is_being_opened({ browser, address, scene, open, keep }) {
    const other = await open();
    const { run } = await state(other);
    const page = keep(await newPage(browser));
    let held;
    // The answers to the page's requests for the old run come too late.
    await page.route(`**/api/runs/${run}/forms?*`, async (route) => {
      held ??= (edit(scene, "velocity = [2.0, 10.0", "velocity = [3.0, 10.0"), another(other, run));
      await held;
      await route.continue();
    });
    await page.goto(address);
    await until(page, (jabuka) => jabuka.drawn.count > 0);
    assert.ok(held);
    assert.equal((await state(page)).run, await held);
    assert.equal((await state(page)).problem, null);
  },

  async two_pages_have_their_own_times_and_see_the_same_scene({ open, scene }) {
    const [one, two] = [await open(), await open()];
    const { run } = await state(one);
    await seek(one, 10);
    await seek(two, 300);
    edit(scene, "velocity = [2.0, 10.0", "velocity = [3.0, 10.0");
    assert.equal(await another(one, run), await another(two, run));
    assert.equal(await drawn(one), 10);
    assert.equal(await drawn(two), 300);
    assert.ok(Math.abs((await x(two)) - (20 + 3 * 12)) < 1e-9);
  },

  async a_run_that_diverges_says_so({ open, scene }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.problem);
    const { stderr } = spawnSync(process.env.JABUKA, ["compile", scene, "-o", join(dirname(scene), "compiled")], { encoding: "utf8" });
    const text = await page.evaluate(() => window.jabuka.problem);
    assert.match(text, /diverge/);
    assert.ok(stderr.includes(text.trim()), `${text} is not ${stderr}`);
    // The frames before the failure can still be shown.
    await seek(page, 1);
    edit(scene, "explicit-euler", "rk4");
    await mended(page);
  },

  async the_end_of_the_server_is_said({ browser, address, scene, open }) {
    // The file `process` holds the process ID of the server.
    const page = await open({ may: [/ERR_/] });
    process.kill(Number(readFileSync(join(dirname(scene), "process"), "utf8")), "SIGINT");
    await until(page, (jabuka) => /server does not answer/.test(jabuka.problem));
  },
});
