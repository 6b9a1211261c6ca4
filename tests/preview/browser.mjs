// Opens pages that record their errors, in a real headless browser.

import assert from "node:assert/strict";
import { existsSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";

import { DOWNLOADS, IS_FIREFOX, launch } from "./launch.mjs";

/** Messages that are no errors: the software WebGL driver says that reading a pixel is slow, and Firefox that it left a page while a font was loading. */
const HARMLESS = [/GL Driver Message .* GPU stall due to ReadPixels/, /^downloadable font: download failed .* status=2152398850 /];

/** The time limit for each wait, ms. It is long enough for a busy machine. */
export const LONG = 240_000;

/** The exit code of a test whose browser no longer answers. */
const NO_ANSWER = 75;

/** Opens a small page that records its errors, its requests, and the runs that it found gone. Messages that match `may` are not errors. */
export async function newPage(browser, { size = { width: 900, height: 640 }, may = [], ...more } = {}) {
  const context = await browser.newContext({ viewport: size, ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(LONG);
  page.wrong = [];
  page.asked = [];
  page.missed = [];
  const note = (text, url = "") => {
    const missed = /status of 404/.test(text) && /\/api\/runs\/(\d+)/.exec(url);
    if (missed) page.missed.push(Number(missed[1]));
    else if (![...HARMLESS, ...may].some((known) => known.test(text))) page.wrong.push(text);
  };
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && note(message.text(), message.location().url));
  page.on("pageerror", (error) => note(String(error)));
  page.on("dialog", (dialog) => (note(`a dialog: ${dialog.message()}`), dialog.dismiss()));
  page.on("request", (request) => page.asked.push(request));
  // Firefox does not write failed requests to the console.
  if (IS_FIREFOX) {
    page.on("response", (response) => response.status() >= 400 && note(`a status of ${response.status()}: ${response.url()}`, response.url()));
    page.on("requestfailed", (request) => request.failure().errorText === "NS_BINDING_ABORTED" || note(`ERR_FAILED: ${request.url()}`));
  }
  return page;
}

/** Opens the preview, and waits until its first frame is drawn. */
export async function open(page, address) {
  await page.goto(address);
  await until(page, (jabuka) => jabuka?.drawn.count > 0);
  return page;
}

/**
 * Runs the test that the command line names: `tests({ async name({ open, scene, … }) { … } })`.
 * Asserts that its pages had no errors, and sent requests to the server only.
 */
export async function tests(all) {
  const [name, address, scene] = process.argv.slice(2);
  // A browser that no longer answers has no limits of its own. `tests/preview/browser` then starts another one, with a longer limit.
  const limit = (process.env.JABUKA_LAST_TRY ? 3 : 1.5) * LONG;
  const late = setTimeout(() => {
    console.error(`${name} has not ended after ${limit / 1000} s`);
    process.exit(NO_ANSWER);
  }, limit);
  const browser = await launch();
  const pages = [];
  // Tests with several pages, or of the time before the first frame, open their pages themselves.
  const keep = (page) => (pages.push(page), page);
  const opened = async (options) => open(keep(await newPage(browser, options)), address);
  const others = [];
  // Starts another browser with these options of `launch`.
  const another = async (options) => {
    others.push(await launch(options));
    return others.at(-1);
  };
  const own = address.split("\n").flatMap((each) => [`${new URL(each).origin}/`, `blob:${new URL(each).origin}/`]);
  const check = async (page) => {
    assert.deepEqual(page.wrong, [], "what the page has complained of");
    // A page may ask for a run that has just been replaced, but never for something that the run which it shows lacks.
    const run = page.missed.length ? await page.evaluate(() => window.jabuka?.run) : undefined;
    assert.ok(!page.missed.includes(run), `a part of run ${run} is missing`);
    const foreign = page.asked.map((request) => request.url()).filter((url) => !own.some((own) => url.startsWith(own)));
    assert.deepEqual(foreign, [], "what the page has asked others for");
    const referers = await Promise.all(page.asked.map((request) => request.headerValue("referer").catch(() => null)));
    assert.ok(referers.every((referer) => !referer?.includes("token")), "the token is in a Referer");
  };
  // Checks a page before the end of the test, and closes it.
  const close = async (page) => {
    await check(page);
    pages.splice(pages.indexOf(page), 1);
    await page.context().close();
  };
  try {
    await all[name]({ browser, address, scene, open: opened, keep, close, another });
    for (const page of pages) await check(page);
  } catch (error) {
    console.error("The pages have complained of", pages.map((page) => [page.url(), page.wrong]));
    throw error;
  } finally {
    for (const each of [browser, ...others]) await each.close();
    clearTimeout(late);
  }
}

/** Waits until `is(window.jabuka, argument)` is true in the page. */
export async function until(page, is, argument, long = LONG) {
  // The page's security policy forbids `eval`, so the condition is inserted into the function that waits for it.
  const came = await page.evaluate(`(async () => {
    const end = performance.now() + ${long};
    while (!(${is})(window.jabuka, ${JSON.stringify(argument)})) {
      if (performance.now() > end) return false;
      // A page that draws nothing more must not keep the limit from being noticed.
      await new Promise((next) => (requestAnimationFrame(next), setTimeout(next, 100)));
    }
    return true;
  })()`);
  assert.ok(came, `in vain: ${is} ${JSON.stringify(argument)}`);
}

/** Waits until the requested frame is drawn, and returns its number. */
export const drawn = (page) => page.evaluate(async () => (await window.jabuka.whenDrawn(), window.jabuka.frame));

/** Goes to a frame, and waits until it is drawn. */
export async function seek(page, frame) {
  await page.evaluate((frame) => window.jabuka.seek(frame), frame);
  assert.equal(await drawn(page), frame);
}

/** Waits until the browser has saved a file with this name, after `deed`, and returns its bytes. */
export async function saved(page, name, deed) {
  if (!IS_FIREFOX) {
    const [download] = await Promise.all([page.waitForEvent("download"), deed()]);
    assert.equal(download.suggestedFilename(), name);
    const late = setTimeout(() => assert.fail(`${name} is not saved`), LONG);
    const file = await download.path();
    clearTimeout(late);
    return readFileSync(file);
  }
  await deed();
  const file = join(DOWNLOADS, name);
  const size = () => (existsSync(file) ? statSync(file).size : 0);
  const end = performance.now() + LONG;
  for (let before; !size() || size() !== before; await page.waitForTimeout(300)) {
    assert.ok(performance.now() < end, `${name} is not saved`);
    before = size();
  }
  return readFileSync(file);
}

/** Waits for all poses of the displayed run, and returns them as one text. */
export async function poses(page) {
  return page.evaluate(async () => {
    const { jabuka } = window;
    await jabuka.whenDrawn(() => jabuka.settled && jabuka.pose(0, jabuka.frames - 1) && jabuka.pose(0, 0));
    const frames = Array.from({ length: jabuka.frames }, (_, frame) => frame);
    await jabuka.whenDrawn(() => frames.every((frame) => jabuka.pose(0, frame)));
    return JSON.stringify(frames.map((frame) => jabuka.bodies.map((_, body) => jabuka.pose(body, frame))));
  });
}
