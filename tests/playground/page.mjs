// Tests of the static page: it simulates scenes in a worker, and nothing leaves the browser.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync, inflateRawSync } from "node:zlib";

import { LONG, newPage, open, saved as savedFile, tests, until } from "../preview/browser.mjs";

const playground = createRequire(join(dirname(fileURLToPath(import.meta.url)), "../../playground/"));

const BALL = "[simulation]\nduration = 1\n\n[body.ball]\nshape.sphere.radius = 0.5\nlocation = [0, 3, 0]\nvelocity = [1, 0, 0]\n";

/** Replaces the text of the editor, as a user would who pastes a scene. */
async function write(page, text) {
  await until(page, (jabuka) => jabuka?.editor);
  await page.evaluate((text) => {
    const { view } = window.jabuka.editor;
    view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
  }, text);
}

/** Waits until a run of the given number of frames is complete and drawn. */
async function shown(page, frames) {
  await until(page, (jabuka, frames) => jabuka?.settled && jabuka.frames === frames && jabuka.problem === null, frames);
  await page.evaluate(() => window.jabuka.whenDrawn());
}

const link = (value) => `#scene=${deflateRawSync(value).toString("base64url")}`;
const said = (page) => page.locator("#said").textContent();

/** Waits until the page says something that matches. */
async function says(page, what) {
  await page.locator("#said", { hasText: what }).waitFor({ timeout: LONG });
}

const textOf = (page) => page.evaluate(() => window.jabuka.editor.view.state.doc.toString());

/** Presses the pointer on a handle. Returns where. */
async function grab(page, key) {
  const handle = page.locator(`.handle[aria-label^="${key} "]`);
  await handle.waitFor();
  const box = await handle.boundingBox();
  const at = { x: box.x + box.width / 2, y: box.y + box.height / 2 };
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  return at;
}

/** Presses a button of the menu `Save`. Returns the bytes of the file, which must have this name. */
async function saved(page, button, name) {
  const bytes = await savedFile(page, name, () => page.getByRole("button", { name: button }).click());
  await page.locator("#save-said", { hasText: `${name} is saved` }).waitFor();
  return bytes;
}

/** Opens the page with a ball that has a red label, at a frame of its run, and the menu `Save`. */
async function openMenu(all, frame) {
  const page = await openBall(all);
  await write(page, `${BALL}\n[label.name]\nbody = "ball"\ntext = "MMM"\ncolor = [1, 0, 0]\nsize = 0.2\n`);
  await until(page, (jabuka) => jabuka.settled && document.getElementById("texts").textContent === "MMM");
  await page.evaluate((frame) => (window.jabuka.seek(frame), window.jabuka.whenDrawn()), frame);
  await page.getByRole("button", { name: "Save" }).click();
  return page;
}

/** Presses the button of the film, with frames from `from` to `to`, and returns the film. */
async function savedFilm(page, { size, format, from, to }) {
  await page.locator("#film-size").selectOption(size.join(" "));
  await page.locator("#film-format").selectOption(format);
  await page.getByLabel("Frames").fill(`${from}`);
  await page.getByLabel("to", { exact: true }).fill(`${to}`);
  return saved(page, "Save film", `ball.${format}`);
}

/** Returns what a film says of itself: its size, its frames, its duration (s). */
function probed(film) {
  const entries = "stream=width,height,nb_read_frames:format=duration";
  const { streams: [stream], format } = JSON.parse(execFileSync("ffprobe", ["-v", "error", "-count_frames", "-show_entries", entries, "-of", "json", "-i", "pipe:"], { input: film }));
  return { size: [stream.width, stream.height], frames: Number(stream.nb_read_frames), duration: Number(format.duration) };
}

/** Returns the pixels of all pictures in a film or an image, three bytes for each. */
function pixels(file) {
  return execFileSync("ffmpeg", ["-v", "error", "-i", "pipe:", "-f", "rawvideo", "-pix_fmt", "rgb24", "-fps_mode", "passthrough", "pipe:"], { input: file, maxBuffer: 1 << 30 });
}

/** Returns the number of red pixels. */
function countRed(bytes) {
  let count = 0;
  for (let i = 0; i < bytes.length; i += 3) count += Number(bytes[i] > 250 && bytes[i + 1] < 5 && bytes[i + 2] < 5);
  return count;
}

/** Returns the mean difference of two pictures of equal size. */
function apart(a, b) {
  let sum = 0;
  for (let i = 0; i < a.length; i++) sum += Math.abs(a[i] - b[i]);
  return sum / a.length;
}

/** Returns the files of a zip file by name, as its directory at the end lists them. */
function unzipped(zip) {
  const files = {};
  const end = zip.lastIndexOf("PK\x05\x06", undefined, "latin1");
  let at = zip.readUInt32LE(end + 16);
  for (let count = zip.readUInt16LE(end + 10); count; count--) {
    const [packed, name, extra, comment, start] = [zip.readUInt32LE(at + 20), zip.readUInt16LE(at + 28), zip.readUInt16LE(at + 30), zip.readUInt16LE(at + 32), zip.readUInt32LE(at + 42)];
    const data = start + 30 + zip.readUInt16LE(start + 26) + zip.readUInt16LE(start + 28);
    files[zip.toString("utf8", at + 46, at + 46 + name)] = inflateRawSync(zip.subarray(data, data + packed));
    at += 46 + name + extra + comment;
  }
  return files;
}

/** Opens the page with a scene of one ball. */
async function openBall({ open, address, keep, browser }) {
  const page = keep(await newPage(browser));
  await page.goto(address + link(JSON.stringify(["ball", BALL])));
  await shown(page, 26);
  return page;
}

await tests({
  async the_first_visit_shows_a_scene({ open }) {
    const page = await open();
    assert.match(await page.title(), /Newton's cradle/);
    await until(page, (jabuka) => jabuka.settled && jabuka.editor);
    assert.match(await page.locator(".cm-content").textContent(), /title = "Newton's cradle"/);
    assert.equal(await page.locator("#render").isVisible(), false);
  },

  async an_edit_is_run_and_an_older_run_is_never_drawn_again(all) {
    const page = await openBall(all);
    const first = await page.evaluate(() => window.jabuka.run);
    // The page notes the run of each frame that it draws.
    await page.evaluate(() => {
      window.drawnRuns = [];
      const note = () => {
        window.drawnRuns.push(window.jabuka.drawn.run);
        requestAnimationFrame(note);
      };
      note();
    });
    for (let k = 1; k <= 10; k++) await write(page, BALL.replace("duration = 1", `duration = ${k}`));
    await shown(page, 251);
    const pose = await page.evaluate(() => window.jabuka.whenDrawn(() => window.jabuka.pose("ball", 250)).then(() => window.jabuka.pose("ball", 250)));
    assert.ok(Math.abs(pose.location[0] - 10) < 1e-9, `${pose.location}`);
    const runs = await page.evaluate(() => window.drawnRuns);
    const order = runs.filter((run, k) => run !== runs[k - 1]);
    assert.equal(new Set(order).size, order.length, `the runs were drawn in this order: ${order}`);
    assert.equal(order[0], first);
  },

  async an_error_is_marked_at_its_place_and_mended_by_a_click(all) {
    const page = await openBall(all);
    await write(page, BALL.replace("velocity", "velosity"));
    await until(page, (jabuka) => jabuka.problem?.includes("velosity"));
    const mark = page.locator(".cm-lintRange-error");
    await mark.first().waitFor();
    assert.equal(await mark.first().textContent(), "velosity");
    await mark.first().hover();
    await page.locator(".cm-diagnosticAction").click();
    await shown(page, 26);
    assert.equal(await page.evaluate(() => window.jabuka.editor.view.state.doc.toString()), BALL);
    // The last valid run stays on the page while there is an error.
    await write(page, BALL.replace("0.5", "-1"));
    await until(page, (jabuka) => jabuka.problem !== null);
    assert.equal(await page.evaluate(() => window.jabuka.frames), 26);
  },

  async warnings_are_folded_and_errors_are_not(all) {
    const page = await openBall(all);
    await write(page, BALL.replace("duration = 1", "duration = 2\ngravity = [0, -9.81, 0]"));
    const fold = page.locator("#warnings");
    await fold.filter({ hasText: /^Warning: `ball` falls below height 0/ }).waitFor();
    const problem = page.locator("#problem");
    assert.equal(await problem.isVisible(), false);
    await fold.focus();
    await page.keyboard.press("Enter");
    assert.match(await problem.textContent(), /^warning\[crossing\]/);
    assert.ok(await problem.isVisible());
    await fold.click();
    assert.equal(await problem.isVisible(), false);
    await write(page, BALL.replace("0.5", "-1"));
    await until(page, (jabuka) => jabuka.problem !== null);
    assert.ok(await problem.isVisible());
    assert.equal(await fold.isVisible(), false);
    await write(page, BALL);
    await until(page, (jabuka) => jabuka.problem === null);
    assert.equal(await problem.isVisible() || await fold.isVisible(), false);
  },

  async twenty_faulty_scenes_are_mended_by_a_click_each(all) {
    const page = await openBall(all);
    await until(page, (jabuka) => jabuka.editor);
    const folder = join(dirname(fileURLToPath(import.meta.url)), "../bad");
    const errors = async () => {
      await until(page, (jabuka) => jabuka.diagnostics !== null);
      return page.evaluate(() => window.jabuka.diagnostics.filter(({ severity }) => severity === "error"));
    };
    await page.locator(".cm-content").focus();
    await page.keyboard.press("Control+Shift+M");
    const action = page.locator(".cm-panel-lint .cm-diagnosticAction").first();
    const mended = [];
    for (const name of readdirSync(folder).filter((name) => name.endsWith(".toml")).sort()) {
      await write(page, readFileSync(join(folder, name), "utf8"));
      const before = await errors();
      if (!before.some(({ fix }) => fix?.length && fix.every(({ file }) => file === "ball.toml"))) continue;
      // The first error is underlined at its place.
      const { line, column } = before[0];
      const underlined = await page.evaluate(([line, column]) => {
        const { view } = window.jabuka.editor;
        const at = view.domAtPos(view.state.doc.line(line).from + column - 1, 1).node;
        return Boolean((at.nodeType === 3 ? at.parentElement : at).closest(".cm-lintRange"));
      }, [line, column]);
      assert.ok(underlined, name);
      const text = await textOf(page);
      await action.click();
      const after = await errors();
      assert.notEqual(await page.evaluate(() => window.jabuka.editor.view.state.doc.toString()), text, name);
      const count = (list, { message }) => list.filter((error) => error.message === message).length;
      assert.ok(before.some((error) => count(after, error) < count(before, error)), `${name}: ${JSON.stringify(after)}`);
      mended.push(name);
      if (mended.length === 20) break;
    }
    assert.equal(mended.length, 20);
  },

  async keys_are_completed_and_explained(all) {
    const page = await openBall(all);
    await write(page, BALL);
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+End");
    await page.keyboard.type("resti");
    const option = page.locator(".cm-tooltip-autocomplete li", { hasText: "restitution" });
    await option.waitFor();
    await option.click();
    assert.match(await page.evaluate(() => window.jabuka.editor.view.state.doc.toString()), /\nrestitution$/);
    await write(page, BALL);
    await page.locator(".cm-line", { hasText: "velocity" }).locator("span").first().hover();
    await page.locator(".described", { hasText: "m/s" }).waitFor();
  },

  async keys_typed_in_the_editor_do_not_control_the_player(all) {
    const page = await openBall(all);
    await page.evaluate(() => window.jabuka.seek(5));
    await until(page, (jabuka) => jabuka.editor);
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+End");
    await page.keyboard.type("# p k l c r ? + -");
    assert.deepEqual(await page.evaluate(() => [window.jabuka.frame, window.jabuka.playing]), [5, false]);
    assert.match(await page.evaluate(() => window.jabuka.editor.view.state.doc.toString()), /# p k l c r \? \+ -$/);
    assert.equal(await page.locator("#keys").isVisible(), false);
  },

  async a_slider_changes_the_text_and_the_motion(all) {
    const page = await openBall(all);
    const text = BALL.replace("[body.ball]", "[variables]\n# ≈ 🎾\nfast = { value = 1, min = 0, max = 3, step = 0.5, unit = 'm/s', title = '<b>speed</b>' }\nslow = { value = 'fast/2', min = 0, max = 3 }\non = { value = 1, min = 0, max = 1, step = 1 }\n\n[body.ball]")
      .replace("[1, 0, 0]", "['fast*on', 'slow', 0]");
    await write(page, text);
    await page.locator("#sliders").waitFor();
    assert.deepEqual(await page.locator("#sliders-list label span").allTextContents(), ["<b>speed</b>", "slow", "on"]);
    const end = async (x, y) => {
      await until(page, (jabuka, [x, y]) => jabuka.settled && jabuka.pose("ball", 25) && Math.hypot(jabuka.pose("ball", 25).location[0] - x, jabuka.pose("ball", 25).location[1] - y) < 1e-9, [x, y]);
    };
    await end(1, 3.5);
    const slider = page.locator("input[name=fast]");
    await slider.focus();
    for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowRight");
    await end(2.5, 4.25);
    assert.equal(await textOf(page), text.replace("value = 1, min = 0, max = 3", "value = 2.5, min = 0, max = 3"));
    assert.equal(await slider.getAttribute("aria-valuetext"), "2.5 m/s");
    await page.locator("input[name=on]").uncheck();
    await end(0, 4.25);
    // A formula is left alone.
    await page.locator("input[name=slow]").fill("2");
    await page.locator("#sliders-said", { hasText: "formula" }).waitFor();
    assert.match(await textOf(page), /slow = \{ value = 'fast\/2'/);
    // Each change can be taken back.
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+z");
    await end(2.5, 4.25);
  },

  async a_number_follows_the_pointer_and_the_keys(all) {
    const page = await openBall(all);
    await until(page, (jabuka) => jabuka.editor);
    const end = (x) => until(page, (jabuka, x) => jabuka.settled && Math.abs(jabuka.pose("ball", 25)?.location[0] - x) < 1e-9, x);
    const at = await page.evaluate(() => {
      const { view } = window.jabuka.editor;
      const { left, top, bottom } = view.coordsAtPos(view.state.doc.toString().indexOf("[1, 0, 0]") + 1);
      return { x: left + 2, y: (top + bottom) / 2 };
    });
    const drag = async (...keys) => {
      for (const key of keys) await page.keyboard.down(key);
      await page.mouse.move(at.x, at.y);
      await page.mouse.down();
      for (let k = 1; k <= 3; k++) await page.mouse.move(at.x + 4 * k, at.y);
      await page.mouse.up();
      for (const key of keys) await page.keyboard.up(key);
    };
    await drag("Alt");
    assert.equal(await textOf(page), BALL.replace("[1, 0, 0]", "[4, 0, 0]"));
    await end(4);
    await drag("Alt", "Shift");
    assert.equal(await textOf(page), BALL.replace("[1, 0, 0]", "[34, 0, 0]"));
    // One drag is one step that is taken back; without the key, the pointer selects.
    await page.locator(".cm-content").focus();
    await page.keyboard.press("Control+z");
    assert.equal(await textOf(page), BALL.replace("[1, 0, 0]", "[4, 0, 0]"));
    await drag();
    assert.equal(await textOf(page), BALL.replace("[1, 0, 0]", "[4, 0, 0]"));
    await page.mouse.click(at.x, at.y);
    await page.keyboard.press("Control+ArrowDown");
    await page.keyboard.press("Control+Shift+ArrowUp");
    assert.equal(await textOf(page), BALL.replace("[1, 0, 0]", "[13, 0, 0]"));
    await end(13);
  },

  async sliders_on_one_line_do_not_write_into_each_other(all) {
    const page = await openBall(all);
    const variables = (a, b) => `variables = { a = { value = ${a}, min = 0, max = 1000 }, b = { value = ${b}, min = 0, max = 1000 } }\n`;
    await write(page, variables(1, 2) + BALL.replace("[1, 0, 0]", "['a', 'b', 0]"));
    await page.locator("input[name=b]").waitFor();
    // Each value that gets longer moves the other value in the text.
    await page.evaluate(() => {
      for (const [name, value] of [["a", 500], ["b", 700], ["a", 5], ["b", 90], ["a", 1000], ["b", 1000]]) {
        const input = document.querySelector(`input[name=${name}]`);
        input.value = value;
        input.dispatchEvent(new Event("input"));
      }
    });
    await until(page, (jabuka) => jabuka.settled && jabuka.pose("ball", 25)?.location[0] > 999 && jabuka.pose("ball", 25).location[1] > 999);
    assert.ok((await page.evaluate(() => window.jabuka.editor.view.state.doc.toString())).startsWith(variables(1000, 1000)));
  },

  async bodies_are_moved_in_the_picture(all) {
    const page = await openBall(all);
    await page.getByRole("button", { name: "Move" }).click();
    const { x, y } = await grab(page, "body.ball.location");
    await page.mouse.move(x + 60, y - 40, { steps: 5 });
    // The ball follows the pointer: the picture of the new run shows it there.
    const ball = () => until(page, (jabuka, [x, y]) => {
      const { clip, width, height, center, size } = jabuka.view;
      const p = jabuka.pose("ball", 0)?.location.map((number, i) => (number - center[i]) / size);
      if (!p) return false;
      const row = (i) => clip[i] * p[0] + clip[4 + i] * p[1] + clip[8 + i] * p[2] + clip[12 + i];
      const stage = document.getElementById("stage").getBoundingClientRect();
      const at = [stage.x + ((row(0) / row(3) + 1) / 2) * width, stage.y + ((1 - row(1) / row(3)) / 2) * height];
      return Math.hypot(at[0] - x, at[1] - y) < 1;
    }, [x + 60, y - 40]);
    await ball();
    await page.mouse.up();
    const [, right, up] = /location = \[([\d.]+), ([\d.]+), 0\]/.exec(await textOf(page));
    assert.ok(Number(right) > 0.2 && Number(up) > 3.2, `${right} ${up}`);
    // Numbers are as round as the picture is coarse, and the whole way is one step.
    assert.ok(right.length <= 5 && up.length <= 5, `${right} ${up}`);
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+z");
    await until(page, (jabuka, before) => jabuka.editor.view.state.doc.toString() === before, BALL);
  },

  async velocities_are_pulled_and_keys_move_handles(all) {
    const page = await openBall(all);
    await page.keyboard.press("Escape");
    await page.locator("#picture").focus();
    await page.keyboard.press("m");
    const { x, y } = await grab(page, "body.ball.velocity");
    await page.mouse.move(x, y - 50, { steps: 3 });
    await page.mouse.up();
    await until(page, (jabuka) => /velocity = \[[\d.]+, [\d.]*[1-9][\d.]*, 0\]/.test(jabuka.editor.view.state.doc.toString()));
    const handle = page.locator('.handle[aria-label^="body.ball.location"]');
    await handle.focus();
    await page.keyboard.press("ArrowUp");
    await until(page, (jabuka) => /location = \[0, 3\.\d*, 0\]/.test(jabuka.editor.view.state.doc.toString()));
    await page.keyboard.press("Shift+ArrowUp");
    await until(page, (jabuka) => /location = \[0, 3\.\d*, -[\d.]+\]/.test(jabuka.editor.view.state.doc.toString()));
    assert.equal(await page.evaluate(() => window.jabuka.frame), 0);
    // A velocity that the text does not give is written below the name of the body.
    await write(page, BALL.replace("velocity = [1, 0, 0]\n", ""));
    await until(page, (jabuka) => jabuka.settled && jabuka.problem === null);
    await until(page, () => document.querySelector('.handle[aria-label^="body.ball.velocity 0"]'));
    const from = await grab(page, "body.ball.velocity");
    await page.mouse.move(from.x + 40, from.y, { steps: 3 });
    await page.mouse.up();
    await until(page, (jabuka) => /\[body\.ball\]\nvelocity = \[[\d.]*[1-9][\d.]*, -?[\d.]+, 0\]\nshape/.test(jabuka.editor.view.state.doc.toString()));
  },

  async formulas_are_not_moved_and_all_kinds_of_points_are(all) {
    const page = await openBall(all);
    await write(page, `${BALL.replace("[0, 3, 0]", '[0, "2 + 1", 0]')}
[joint.rod]
rod.between = ["ball", [0, 5, 0]]

[light.lamp]
point.location = [4, 6, 4]

[camera]
location = [0, 3, 12]
look_at = [0, 3, 0]
`);
    await until(page, (jabuka) => jabuka.settled && jabuka.problem === null);
    await page.getByRole("button", { name: "Move" }).click();
    const keys = () => page.locator(".handle").evaluateAll((all) => all.map((one) => one.getAttribute("aria-label").split(" ")[0]).sort());
    const usual = ["body.ball.location", "body.ball.velocity", "joint.rod.rod.between[1]", "light.lamp.point.location"];
    await until(page, (_, count) => document.querySelectorAll(".handle").length === count, usual.length);
    assert.deepEqual(await keys(), usual);
    const { x, y } = await grab(page, "body.ball.location");
    await page.mouse.move(x + 40, y + 40, { steps: 3 });
    await page.mouse.up();
    await says(page, "A formula of `body.ball.location` stays as it is");
    assert.match(await textOf(page), /location = \[[\d.]+, "2 \+ 1", 0\]/);
    // The camera is seen from elsewhere only.
    await page.getByRole("button", { name: "Scene camera" }).click();
    await until(page, (_, count) => document.querySelectorAll(".handle").length === count, usual.length + 2);
    assert.deepEqual(await keys(), [...usual, "camera.location", "camera.look_at"].sort());
    await page.getByRole("button", { name: "Move" }).click();
    await until(page, () => !document.querySelector(".handle"));
  },

  async the_tutorial_goes_from_a_ball_to_a_link({ open, address, keep, browser }) {
    const page = keep(await newPage(browser));
    await page.goto(`${address}#tutorial`);
    const heading = page.locator("#tutorial h2");
    const done = page.locator("#tutorial .done");
    const next = page.getByRole("button", { name: "Next" });
    const mend = page.getByRole("button", { name: "Do it for me" });
    const editor = () => textOf(page);
    await until(page, (jabuka) => jabuka?.settled && jabuka.editor);
    const ways = [
      () => page.evaluate(() => window.jabuka.seek(20)),
      () => mend.click(),
      async () => {
        const text = await editor();
        await write(page, text.replace("velocity", "velocty"));
        await until(page, (jabuka) => jabuka.problem !== null);
        await new Promise((resolve) => setTimeout(resolve, 500));
        assert.equal(await done.textContent(), "");
        await write(page, text);
      },
      () => mend.click(),
      async () => {
        await mend.click();
        const slider = page.locator("input[name=up]");
        await slider.waitFor();
        await until(page, (jabuka) => jabuka.settled && jabuka.problem === null);
        await new Promise((resolve) => setTimeout(resolve, 500));
        await slider.fill("5");
      },
      () => page.locator("input[name=up]").fill("7.7"),
      async () => {
        await page.locator("#body-name").fill("ball");
        await page.locator("#body-name").press("Enter");
      },
      () => page.locator("#other-integrator").selectOption("rk4"),
      () => page.getByRole("button", { name: "Copy link" }).click(),
    ];
    for (const [number, deed] of ways.entries()) {
      await heading.filter({ hasText: `Step ${number + 1} of ${ways.length}` }).waitFor();
      assert.equal(await done.textContent(), "");
      await deed();
      await done.filter({ hasText: "✓" }).waitFor();
      if (number + 1 < ways.length) await next.click();
    }
    assert.equal(await next.isVisible(), false);
    await page.locator("#tutorial").getByRole("button", { name: "Close" }).click();
    assert.equal(await page.locator("#tutorial").isVisible(), false);
  },

  async the_trail_and_the_arrows_of_the_chosen_body_are_drawn(all) {
    const page = await openBall(all);
    assert.equal(await page.locator("#body-shows").isVisible(), false);
    await page.locator("#body-name").fill("ball");
    await page.locator("#body-name").press("Enter");
    await page.evaluate(() => window.jabuka.seek(20));
    /** The bytes of the picture once nothing changes it any more. */
    const picture = async () => {
      let [last, now] = [undefined, ""];
      while (last !== now) {
        last = now;
        await new Promise((resolve) => setTimeout(resolve, 300));
        now = await page.evaluate(() => document.getElementById("picture").toDataURL());
      }
      return now;
    };
    const bare = await picture();
    const seen = new Set([bare]);
    // The ball moves evenly, without a force. So there is a trail and a velocity, and no arrow of a force.
    for (const what of ["trail", "velocity"]) {
      await page.locator(`#show-${what}`).check();
      seen.add(await picture());
    }
    assert.equal(seen.size, 3);
    await page.locator("#show-force").check();
    seen.add(await picture());
    assert.equal(seen.size, 3);
    for (const what of ["trail", "velocity", "force"]) await page.locator(`#show-${what}`).uncheck();
    assert.equal(await picture(), bare);
  },

  async the_script_of_a_body_is_shown(all) {
    const page = await openBall(all);
    const part = page.locator("#script-part");
    assert.equal(await part.isVisible(), false);
    await page.locator("#body-name").fill("ball");
    await page.locator("#body-name").press("Enter");
    await part.locator("summary").click();
    const text = page.locator("#script-text");
    await text.filter({ hasText: "sphere { <0, 3, 0>, 0.5 } // ball" }).waitFor();
    await page.evaluate(() => window.jabuka.seek(25));
    await text.filter({ hasText: "sphere { <1, 3, 0>, 0.5 } // ball" }).waitFor();
  },

  async a_link_holds_the_scene(all) {
    const page = await openBall(all);
    const text = BALL.replace("[1, 0, 0]", '["2*pi", 0, 0] # ≈ 2π');
    await write(page, text);
    await page.getByRole("button", { name: "Copy link" }).click();
    await until(page, (jabuka, before) => location.hash !== before, link(JSON.stringify(["ball", BALL])));
    const address = page.url();
    assert.ok(address.startsWith(`${all.address}#scene=`) && address.length < 400, address);
    const other = all.keep(await newPage(all.browser));
    await other.goto(address);
    await shown(other, 26);
    await until(other, (jabuka) => jabuka.editor);
    assert.equal(await other.evaluate(() => window.jabuka.editor.view.state.doc.toString()), text);
    assert.ok(page.asked.every((request) => !request.url().includes("scene=") || request.isNavigationRequest()));
  },

  async damaged_and_hostile_links_are_refused({ address, keep, browser }) {
    const bomb = Buffer.alloc(200 << 20, "a");
    const hashes = [
      "#scene=AAAA", "#scene=%00", link("no JSON"), link(JSON.stringify(["../x", BALL])), link(JSON.stringify([1, 2])), link(JSON.stringify(["a", BALL]).slice(0, 30)),
      link(JSON.stringify({ name: "<img src=x onerror=alert(1)>", text: BALL })), link(bomb), "#gallery=nothing", "#gallery=__proto__",
    ];
    for (const hash of hashes) {
      const page = keep(await newPage(browser));
      await page.goto(address + hash);
      await until(page, (jabuka) => jabuka?.drawn.count > 0);
      const text = await said(page);
      const isKnown = /damaged|no example/.test(text) || hash === "#scene=%00";
      assert.ok(isKnown, `${hash.slice(0, 60)}: ${text}`);
      await page.context().close();
    }
    const page = keep(await newPage(browser));
    const title = '<img src=x onerror="alert(1)"><script>alert(2)</script>';
    await page.goto(address + link(JSON.stringify(["a", `title = '${title}'\n${BALL}`])));
    await shown(page, 26);
    assert.equal(await page.locator("#title").textContent(), title);
  },

  async a_link_to_a_faulty_scene_opens_and_can_be_mended({ address, keep, browser }) {
    const page = keep(await newPage(browser));
    await page.goto(address + link(JSON.stringify(["ball", BALL.replace("velocity", "velosity")])));
    await until(page, (jabuka) => jabuka?.problem?.includes("velosity"));
    await page.locator(".cm-lintRange-error").first().hover();
    await page.locator(".cm-diagnosticAction").click();
    await shown(page, 26);
  },

  async an_edit_outlives_a_reload(all) {
    const page = await openBall(all);
    const edited = BALL.replace("[1, 0, 0]", "[2, 0, 0]");
    await write(page, edited);
    await until(page, (jabuka) => jabuka.settled && Math.abs(jabuka.pose("ball", 25)?.location[0] - 2) < 1e-9);
    await page.reload();
    await shown(page, 26);
    await until(page, (jabuka) => jabuka.editor);
    assert.equal(await textOf(page), edited);
    await page.getByRole("button", { name: "Start anew" }).click();
    await until(page, (jabuka, text) => jabuka.editor.view.state.doc.toString() === text, BALL);
    // Another address has its own scene.
    await page.goto(`${all.address}#gallery=projectile`);
    await until(page, (jabuka) => jabuka.settled && jabuka.frames !== 26);
  },

  async a_scene_that_takes_for_ever_gives_way_to_the_next(all) {
    const page = await openBall(all);
    // One frame of this run takes hours.
    await write(page, BALL.replace("duration = 1", "duration = 1e6\nframe_rate = 1e-6\nstep = 1e-3"));
    await until(page, (jabuka) => jabuka.problem !== null || jabuka.frames !== 26 || jabuka.editor, null);
    await page.waitForTimeout(1500);
    await page.getByRole("button", { name: "Play" }).click();
    await write(page, BALL.replace("duration = 1", "duration = 2"));
    await shown(page, 51);
    // All copies of this body need more memory than there is.
    await write(page, `${BALL}repeat = 1000000000\n`);
    await until(page, (jabuka) => jabuka.problem !== null);
    await write(page, BALL.replace("duration = 1", "duration = 3"));
    await shown(page, 76);
  },

  async every_scene_of_the_shelf_opens({ open, address }) {
    const page = await open();
    await page.getByRole("button", { name: "Examples" }).click();
    const count = await page.locator(".card").count();
    assert.ok(count > 60, `${count}`);
    assert.ok(await page.locator(".card img").first().evaluate((image) => image.decode().then(() => image.naturalWidth === 320)));
    await page.locator(".card", { hasText: "A first scene" }).click();
    await until(page, () => document.title.startsWith("A first scene"));
    await page.getByRole("button", { name: "Examples" }).click();
    await page.locator(".card", { hasText: "Two carts" }).click();
    await until(page, () => document.title.startsWith("Two carts"));
    assert.equal(new URL(page.url()).hash, "#gallery=carts");
    assert.equal(await page.locator("#shelf").isVisible(), false);
    // Scenes that are nothing but text are read at once, those with other files from the virtual folder.
    const shelf = await (await fetch(`${address}scenes/shelf.json`)).json();
    const names = shelf.flatMap(({ scenes }) => scenes.map(({ name }) => name));
    assert.equal(new Set(names).size, count);
    for (const name of names) {
      await page.goto(`${address}#gallery=${name}`);
      await until(page, (jabuka, name) => jabuka?.name === name && (jabuka.recorded > 0 || jabuka.problem !== null), name);
      assert.equal(await page.evaluate(() => window.jabuka.problem), null, name);
    }
  },

  async files_that_are_dropped_lie_beside_the_scene(all) {
    const page = await openBall(all);
    const mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    const text = "simulation.duration = 2\n[body.a]\nshape.mesh.file = 'solid.obj'\n";
    await write(page, text);
    await until(page, (jabuka) => jabuka.problem?.includes("solid.obj"));
    await page.evaluate((mesh) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([mesh], "solid.obj"));
      window.dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
    }, mesh);
    await shown(page, 51);
    await says(page, "solid.obj");
  },

  async a_picture_has_the_chosen_size_and_its_labels(all) {
    const page = await openMenu(all, 12);
    const size = page.locator("#picture-size");
    const shown = await page.locator("#film").boundingBox();
    // The page may be drawing, which replaces its letters.
    let letters;
    const limit = performance.now() + LONG;
    while (!(letters = await page.locator("#texts span").boundingBox())) assert.ok(performance.now() < limit, "there are no letters");
    for (const [value, width, height] of [["shown", Math.round(shown.width), Math.round(shown.height)], ["1280 720", 1280, 720], ["1920 1080", 1920, 1080]]) {
      await size.selectOption(value);
      const png = await saved(page, "Save picture", "ball_12.png");
      assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [width, height]);
      const all = pixels(png);
      assert.ok(new Set(all.subarray(0, 3 * width * height)).size > 50, "the picture is not uniform");
      // The letters are where the page has them, and as large.
      const scale = width / shown.width;
      const [left, top, right, bottom] = [letters.x - shown.x, letters.y - shown.y, letters.x - shown.x + letters.width, letters.y - shown.y + letters.height].map((c) => Math.round(c * scale));
      const rows = Array.from({ length: bottom - top + 5 }, (_, y) => all.subarray(3 * ((top + y - 2) * width + left - 2), 3 * ((top + y - 2) * width + right + 2)));
      const count = countRed(all);
      assert.ok(count > 0.1 * (right - left) * (bottom - top), `${count} red pixels of ${right - left} × ${bottom - top}`);
      assert.equal(rows.reduce((sum, row) => sum + countRed(row), 0), count);
      // Nothing is black: neither margins nor what was not drawn.
      for (const corner of [0, width - 1, width * (height - 1), width * height - 1]) assert.ok(all[3 * corner] + all[3 * corner + 1] + all[3 * corner + 2] > 100);
    }
    // The page goes on as before.
    await page.getByRole("button", { name: "Close" }).click();
    await page.evaluate(() => window.jabuka.whenDrawn());
    const { view, frame } = await page.evaluate(() => window.jabuka);
    const stage = await page.locator("#picture").boundingBox();
    assert.deepEqual([view.width, view.height, frame], [stage.width, stage.height, 12]);
  },

  async a_film_has_all_of_its_frames_in_order(all) {
    const page = await openMenu(all, 12);
    await page.locator("#picture-size").selectOption("1280 720");
    const picture = pixels(await saved(page, "Save picture", "ball_12.png"));
    const whole = await savedFilm(page, { size: [640, 360], format: "webm", from: 0, to: 25 });
    const { duration, ...film } = probed(whole);
    assert.deepEqual(film, { size: [640, 360], frames: 26 });
    assert.ok(Math.abs(duration - 26 / 25) < 2e-3, `${duration} s`);
    const part = await savedFilm(page, { size: [1280, 720], format: "webm", from: 10, to: 14 });
    assert.equal(probed(part).frames, 5);
    const frames = pixels(part);
    const differences = [0, 1, 2, 3, 4].map((k) => apart(frames.subarray(k * picture.length, (k + 1) * picture.length), picture));
    assert.ok(differences[2] < 3 && [0, 1, 3, 4].every((k) => differences[k] > differences[2]), `${differences}`);
    await page.getByRole("button", { name: "Close" }).click();
    await page.evaluate(() => window.jabuka.whenDrawn());
    assert.equal(await page.evaluate(() => window.jabuka.frame), 12);
  },

  async a_film_can_be_stopped_and_the_page_goes_on(all) {
    const page = await openMenu(all, 3);
    page.on("download", () => assert.fail("a film that was stopped is not saved"));
    await page.getByLabel("to", { exact: true }).fill("99");
    await page.getByRole("button", { name: "Save film" }).click();
    await page.locator("#save-said", { hasText: "0 to 25" }).waitFor();
    await page.getByLabel("to", { exact: true }).fill("25");
    await page.getByRole("button", { name: "Save film" }).click();
    await until(page, () => document.getElementById("save-progress").value > 0);
    await page.getByRole("button", { name: "Stop" }).click();
    await page.locator("#save-said", { hasText: "Nothing is saved" }).waitFor();
    assert.equal(await page.evaluate(() => document.activeElement.id), "save-film");
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#save-dialog").isVisible(), false);
    assert.equal(await page.evaluate(() => window.jabuka.whenDrawn().then(() => window.jabuka.frame)), 3);
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => window.jabuka.whenDrawn().then(() => window.jabuka.frame)), 4);
  },

  async without_an_encoder_the_menu_says_so({ browser, keep, address }) {
    const page = keep(await newPage(browser));
    await page.addInitScript(() => delete window.VideoEncoder);
    await open(page, address);
    await page.getByRole("button", { name: "Save" }).click();
    assert.equal(await page.getByRole("button", { name: "Save film" }).isEnabled(), false);
    assert.match(await page.locator("#film-note").textContent(), /no WebCodecs/);
  },

  async the_model_and_the_table_have_these_bytes({ open, scene: folder, address }) {
    const page = await open();
    await page.goto(`${address}#gallery=hammer`);
    await until(page, (jabuka) => jabuka?.name === "hammer" && jabuka.settled);
    await page.getByRole("button", { name: "Save" }).click();
    for (const [button, name] of [["Save model", "hammer.glb"], ["Save table", "hammer.csv"]]) {
      assert.ok((await saved(page, button, name)).equals(readFileSync(join(folder, name))), name);
    }
  },

  async the_zip_file_has_these_files({ open, scene: folder, address }) {
    const page = await open();
    await page.goto(`${address}#gallery=hammer`);
    await until(page, (jabuka) => jabuka?.name === "hammer" && jabuka.settled);
    await page.getByRole("button", { name: "Save" }).click();
    const files = unzipped(await saved(page, "Save scripts", "hammer.zip"));
    const expected = readdirSync(folder, { recursive: true }).filter((name) => statSync(join(folder, name)).isFile());
    const own = expected.map((name) => relative(folder, join(folder, name))).filter((name) => !/^manifest|^\./.test(name)).sort();
    assert.deepEqual(Object.keys(files).sort(), own);
    for (const name of own) assert.ok(Buffer.from(files[name]).equals(readFileSync(join(folder, name))), name);
  },

  async an_address_chooses_the_parts_of_the_page({ address, keep, browser }) {
    const page = keep(await newPage(browser));
    await page.goto(`${address}?show=player,values#gallery=newtons_cradle`);
    await until(page, (jabuka) => jabuka?.drawn.count > 0 && jabuka.settled);
    const visible = (id) => page.locator(id).isVisible();
    assert.deepEqual(await Promise.all(["#picture", "#controls", "#panel", "#editor", "#plots", "header"].map(visible)), [true, true, true, false, false, false]);
    // Without an editor, a slider changes the text all the same.
    const run = await page.evaluate(() => window.jabuka.run);
    await page.locator("input[name=lifted]").fill("3");
    await until(page, (jabuka, run) => jabuka.run !== run && jabuka.settled, run);
    const places = await page.evaluate(() => ["ball[0]", "ball[2]", "ball[3]"].map((name) => window.jabuka.pose(name, 0).location[1]));
    assert.ok(places[0] > places[2] + 0.05 && places[1] > places[2] + 0.05, `${places}`);
  },

  async it_works_without_a_network_after_the_first_visit({ open, address, scene: server }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.editor);
    await page.evaluate(() => navigator.serviceWorker.ready);
    // The library's own way to take away the network leaves it to service workers in Firefox.
    process.kill(Number(server));
    await page.reload();
    await until(page, (jabuka) => jabuka?.drawn.count > 0 && jabuka.editor);
    await write(page, BALL);
    await shown(page, 26);
    // So does a scene that was never opened before.
    await page.goto(`${address}#gallery=carts`);
    await until(page, (jabuka) => jabuka?.name === "carts" && jabuka.recorded > 0);
  },

  async small_windows_show_all_of_it({ keep, browser, address }) {
    for (const [width, height] of [[360, 640], [640, 380], [800, 600], [1280, 720], [1920, 1080]]) {
      const page = keep(await newPage(browser, { size: { width, height } }));
      await open(page, address);
      await until(page, (jabuka) => jabuka.editor);
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(overflow <= 0, `${width} × ${height}: ${overflow} pixels are outside`);
      for (const id of ["picture", "editor", "controls", "sliders", "plots", "body"]) {
        const element = page.locator(`#${id}`);
        await element.scrollIntoViewIfNeeded();
        const box = await element.boundingBox();
        assert.ok(box.width >= 150 && box.height >= 30, `${width} × ${height}: ${id} ${JSON.stringify(box)}`);
      }
      await page.context().close();
    }
  },

  async accessibility_rules_hold({ keep, another, address }) {
    const axe = readFileSync(playground.resolve("axe-core/axe.min.js"), "utf8");
    for (const colorScheme of ["light", "dark"]) {
      const page = keep(await newPage(await another({ colorScheme }), { colorScheme }));
      await page.goto(address);
      assert.equal(await page.evaluate(() => matchMedia("(prefers-color-scheme: dark)").matches), colorScheme === "dark");
      await until(page, (jabuka) => jabuka?.drawn.count > 0 && jabuka.settled && jabuka.editor);
      await page.evaluate(axe);
      for (const deed of [null, "Examples", "Save"]) {
        await page.keyboard.press("Escape");
        if (deed) await page.getByRole("button", { name: deed }).click();
        const { violations } = await page.evaluate("axe.run()");
        const found = violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)]);
        assert.deepEqual(found, [], `${colorScheme} ${deed}`);
      }
    }
  },
});
