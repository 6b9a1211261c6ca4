// Tests of the editor, which writes into the file of the scene.

import assert from "node:assert/strict";
import { chmodSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname } from "node:path";
import { LONG, newPage, tests, until } from "./browser.mjs";

/** Waits until the ball is at this place at the end of the run, after 1 s. */
async function end(page, x) {
  await until(page, (jabuka, x) => jabuka.settled && Math.abs(jabuka.pose("ball", 25)?.location[0] - x) < 1e-9, x);
}

/** Opens the text beside the picture. The page may write when another program has changed the file, or when the file cannot be written. */
async function opened(open) {
  const page = await open({ may: [/status of 409/, /status of 500/] });
  await page.getByRole("button", { name: "Text", exact: true }).click();
  await until(page, (jabuka) => jabuka.editor);
  return page;
}

const text = (page) => page.evaluate(() => window.jabuka.editor.view.state.doc.toString());

/** Replaces a part of the text, as a user would who types. */
async function type(page, before, after) {
  await page.evaluate(([before, after]) => {
    const { view } = window.jabuka.editor;
    const from = view.state.doc.toString().indexOf(before);
    view.dispatch({ changes: { from, to: from + before.length, insert: after } });
  }, [before, after]);
}

/** Waits until a condition on the file holds. */
async function file(scene, is) {
  const begun = performance.now();
  while (!is(readFileSync(scene, "utf8"))) {
    assert.ok(performance.now() - begun < LONG, readFileSync(scene, "utf8"));
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

/** Writes a line into the text while another program writes into the file: the page does not pause, so it neither writes its text nor takes the new one. */
async function conflict(page, scene, theirs, mine) {
  await page.evaluate(() => {
    const { view } = window.jabuka.editor;
    const from = view.state.doc.toString().indexOf("duration");
    view.dispatch({ changes: { from, insert: "#\n" } });
    window.typing = setInterval(() => view.dispatch({ changes: { from: from + 1, insert: "." } }), 50);
  });
  writeFileSync(scene, theirs);
  await page.evaluate((mine) => {
    clearInterval(window.typing);
    const { view } = window.jabuka.editor;
    const [typed] = /^#\.*$/m.exec(view.state.doc.toString());
    const from = view.state.doc.toString().indexOf(typed);
    view.dispatch({ changes: { from, to: from + typed.length, insert: mine } });
  }, mine);
  await says(page, "Another program has changed the file.");
  assert.equal(readFileSync(scene, "utf8"), theirs);
}

const says = (page, what) => page.locator("#said", { hasText: what }).waitFor();

await tests({
  async an_edit_is_written_into_the_file_and_run({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await opened(open);
    assert.equal(await text(page), before.replaceAll("\r\n", "\n"));
    await type(page, "value = 1", "value = 2");
    await end(page, 2);
    // The file keeps its kind of line ends, and nothing else lies beside it.
    await file(scene, (now) => now === before.replace("value = 1", "value = 2"));
    assert.deepEqual(readdirSync(dirname(scene)).filter((name) => name.includes("toml")), ["scene.toml"]);
  },

  async an_error_is_mended_by_a_click_in_the_file({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await opened(open);
    await type(page, "velocity", "velosity");
    await until(page, (jabuka) => jabuka.problem?.includes("velosity"));
    const mark = page.locator(".cm-lintRange-error").first();
    await mark.hover();
    await page.locator(".cm-diagnosticAction").click();
    await until(page, (jabuka) => jabuka.problem === null);
    await file(scene, (now) => now === before);
  },

  async a_scene_that_is_faulty_from_the_beginning_is_mended({ address, browser, keep }) {
    const page = keep(await newPage(browser));
    await page.goto(address);
    await until(page, (jabuka) => jabuka?.problem?.includes("velosity"));
    await page.getByRole("button", { name: "Text", exact: true }).click();
    await until(page, (jabuka) => jabuka.editor);
    await type(page, "velosity", "velocity");
    await end(page, 1);
  },

  async a_change_from_outside_is_shown_and_can_be_taken_back({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await opened(open);
    writeFileSync(scene, before.replace("value = 1", "value = 3"));
    await end(page, 3);
    await until(page, (jabuka) => jabuka.editor.view.state.doc.toString().includes("value = 3"));
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+z");
    await file(scene, (now) => now === before);
    await end(page, 1);
  },

  async a_file_that_changed_meanwhile_is_not_overwritten({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const theirs = before.replace("value = 1", "value = 3");
    const page = await opened(open);
    await conflict(page, scene, theirs, "# first");
    await page.getByRole("button", { name: "Take its text" }).click();
    await until(page, (jabuka) => jabuka.editor.view.state.doc.toString().includes("value = 3"));
    assert.equal(await text(page), theirs.replaceAll("\r\n", "\n"));
    // The text of the page is not lost: it can be had again.
    await page.locator(".cm-content").click();
    await page.keyboard.press("Control+z");
    await file(scene, (now) => now === before.replace("duration", "# first\r\nduration"));
    await until(page, (jabuka) => document.getElementById("said").textContent === "");
    await type(page, "# first\n", "");
    await file(scene, (now) => now === before);
    await conflict(page, scene, theirs, "# second");
    await page.getByRole("button", { name: "Keep this text" }).click();
    await file(scene, (now) => now === before.replace("duration", "# second\r\nduration"));
  },

  async a_text_is_kept_although_a_write_before_the_choice_comes_late({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await opened(open);
    await conflict(page, scene, before.replace("value = 1", "value = 3"), "# first");
    let release;
    const isHeld = new Promise((held) => {
      page.route("**/api/save?*", async (route) => {
        if (!release) await new Promise((resolve) => ((release = resolve), held()));
        await route.continue();
      });
    });
    await type(page, "# first", "# second");
    await isHeld;
    await page.getByRole("button", { name: "Keep this text" }).click();
    // Long enough for the answer to a question that does not wait.
    await page.waitForTimeout(200);
    release();
    await file(scene, (now) => now === before.replace("duration", "# second\r\nduration"));
  },

  async a_slider_writes_into_the_open_text({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await opened(open);
    await page.locator("input[name=fast]").focus();
    for (let k = 0; k < 4; k++) await page.keyboard.press("ArrowRight");
    await end(page, 3);
    await file(scene, (now) => now === before.replace("value = 1", "value = 3"));
    // When the text is closed, the file stays.
    await page.getByRole("button", { name: "Text", exact: true }).click();
    await page.locator("input[name=fast]").focus();
    await page.keyboard.press("ArrowLeft");
    await end(page, 2.5);
    assert.equal(readFileSync(scene, "utf8"), before.replace("value = 1", "value = 3"));
  },

  async a_file_that_cannot_be_written_says_so({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await opened(open);
    chmodSync(scene, 0o444);
    await type(page, "value = 1", "value = 2");
    await says(page, "read-only");
    assert.equal(readFileSync(scene, "utf8"), before);
    assert.match(await text(page), /value = 2/);
    chmodSync(scene, 0o644);
    await type(page, "value = 2", "value = 3");
    await file(scene, (now) => now === before.replace("value = 1", "value = 3"));
  },

  async the_text_opens_by_a_key_and_breaks_no_rule({ open, scene }) {
    const before = readFileSync(scene, "utf8");
    const page = await open();
    assert.equal(await page.locator("#editor").isVisible(), false);
    await page.keyboard.press("t");
    await until(page, (jabuka) => jabuka.editor?.view.hasFocus);
    await page.keyboard.press("Control+End");
    await page.keyboard.type("restitu");
    await page.locator(".cm-tooltip-autocomplete li", { hasText: "restitution" }).click();
    await page.keyboard.type(" = 0.5");
    await file(scene, (now) => now === `${before}restitution = 0.5`);
    // The keys of the player were typed into the text.
    assert.equal(await page.evaluate(() => window.jabuka.frame), 0);
  },

  async a_read_only_preview_has_no_editor({ open, scene }) {
    const page = await open();
    assert.equal(await page.locator("#edit").isVisible(), false);
    await page.keyboard.press("t");
    assert.equal(await page.locator("#editor").isVisible(), false);
  },
});
