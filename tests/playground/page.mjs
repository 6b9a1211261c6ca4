// Tests of the static page: it simulates scenes in a worker, and nothing leaves the browser.

import assert from "node:assert/strict";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";

import { LONG, newPage, open, saved, tests, until } from "../preview/browser.mjs";

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
    const text_of = () => page.evaluate(() => window.jabuka.editor.view.state.doc.toString());
    const end = async (x, y) => {
      await until(page, (jabuka, [x, y]) => jabuka.settled && jabuka.pose("ball", 25) && Math.hypot(jabuka.pose("ball", 25).location[0] - x, jabuka.pose("ball", 25).location[1] - y) < 1e-9, [x, y]);
    };
    await end(1, 3.5);
    const slider = page.locator("input[name=fast]");
    await slider.focus();
    for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowRight");
    await end(2.5, 4.25);
    assert.equal(await text_of(), text.replace("value = 1, min = 0, max = 3", "value = 2.5, min = 0, max = 3"));
    assert.equal(await slider.getAttribute("aria-valuetext"), "2.5 m/s");
    await page.locator("input[name=on]").uncheck();
    await end(0, 4.25);
    // A formula is left alone.
    await page.locator("input[name=slow]").fill("2");
    await page.locator("#sliders-said", { hasText: "formula" }).waitFor();
    assert.match(await text_of(), /slow = \{ value = 'fast\/2'/);
    // Each change can be taken back.
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+z");
    await end(2.5, 4.25);
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

  async the_zip_file_has_these_files({ open, scene: folder, address }) {
    const { unzipSync } = playground("fflate");
    const page = await open();
    await page.goto(`${address}#gallery=hammer`);
    await until(page, (jabuka) => jabuka?.name === "hammer" && jabuka.settled);
    const zip = await saved(page, "hammer.zip", () => page.getByRole("button", { name: "Scripts" }).click());
    const files = unzipSync(zip);
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
      for (const id of ["picture", "editor", "controls", "plots", "panel"]) {
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
      for (const deed of [null, "Examples"]) {
        if (deed) await page.getByRole("button", { name: deed }).click();
        const { violations } = await page.evaluate("axe.run()");
        const found = violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)]);
        assert.deepEqual(found, [], `${colorScheme} ${deed}`);
      }
    }
  },
});
