// Tests of a run that was exported as one file.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { drawn, newPage, open as openAt, poses, seek, tests, until } from "./browser.mjs";

const FILE = "scene.html";

/** Returns what a page shows of the bodies, the energies and the chosen body. */
async function shown(page) {
  await until(page, (jabuka) => jabuka.settled);
  await seek(page, 20);
  await page.locator("#body-name").fill("ball");
  await page.locator("#body-name").press("Enter");
  await page.locator("#body-values td").first().waitFor();
  await until(page, (jabuka) => jabuka.plot.curves.length > 2);
  const { curves } = await page.evaluate(() => window.jabuka.plot);
  return { poses: await poses(page), curves, values: await page.locator("#body-values").textContent(), texts: await page.locator("#texts").textContent() };
}

await tests({
  async a_run_as_one_file_shows_what_the_preview_shows({ browser, open }) {
    const page = await openAt(await newPage(browser), pathToFileURL(FILE).href);
    assert.deepEqual(await shown(page), await shown(await open()));
    await page.locator("#save").click();
    assert.ok(await page.locator("#save-picture").isVisible());
    for (const id of ["method-heading", "sliders", "save-film", "save-model", "save-page", "save-scripts", "render", "edit"]) {
      assert.ok(await page.locator(`#${id}`).isHidden(), id);
    }
    assert.deepEqual(page.wrong, []);
    const foreign = page.asked.map((request) => request.url()).filter((url) => !/^(file|data|blob):/.test(url));
    assert.deepEqual(foreign, []);
  },

  async a_page_says_which_values_it_leaves_out({ browser }) {
    const page = await openAt(await newPage(browser), pathToFileURL(FILE).href);
    await page.locator("#body-name").fill("ball[7]");
    await page.locator("#body-name").press("Enter");
    await page.locator("#body-values", { hasText: "This file does not hold these values." }).waitFor();
    await seek(page, 50);
    assert.deepEqual(page.wrong, []);
  },

  /** Notebooks show the page in a frame that holds its text. */
  async a_run_as_one_file_plays_in_a_frame({ browser }) {
    const page = await newPage(browser);
    await page.setContent('<iframe style="width: 800px; height: 480px"></iframe>');
    await page.locator("iframe").evaluate((frame, text) => (frame.srcdoc = text), readFileSync(FILE, "utf8"));
    const handle = await page.locator("iframe").elementHandle();
    const frame = await handle.contentFrame();
    await frame.waitForLoadState();
    await until(frame, (jabuka) => jabuka?.drawn.count > 0);
    await frame.evaluate(() => window.jabuka.play());
    await until(frame, (jabuka) => jabuka.frame > 3);
    await frame.evaluate(() => window.jabuka.pause());
    await drawn(frame);
    assert.deepEqual(page.wrong, []);
  },
});
