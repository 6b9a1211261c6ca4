// Tests of rendering a frame with POV-Ray.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { LONG, seek, tests, until } from "./browser.mjs";

/** Collects the images that the page will show. */
async function collectImages(page) {
  await page.evaluate(() => {
    window.images = [];
    const make = URL.createObjectURL;
    URL.createObjectURL = (blob) => (window.images.push(blob), make.call(URL, blob));
  });
}

/** Returns the bytes of the images that the page has shown. */
async function collected(page) {
  const images = await page.evaluate(() => Promise.all(window.images.map(async (blob) => Array.from(new Uint8Array(await blob.arrayBuffer())))));
  return images.map((bytes) => Buffer.from(bytes));
}

await tests({
  /** Writes the images to `draft.png` and `final.png`; the Rust test compares them with those of `jabuka still`. */
  async a_frame_is_rendered_first_as_a_draft_and_then_as_the_final_image({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 6);
    await page.evaluate(() => {
      window.said = [];
      const status = document.getElementById("render-status");
      const note = () => window.said.push([status.textContent, document.getElementById("rendered").naturalWidth]);
      new MutationObserver(note).observe(status, { childList: true });
    });
    await collectImages(page);
    await page.locator("#render").click();
    await page.waitForFunction(() => /^frame 6, final$/.test(document.getElementById("render-status").textContent));
    const said = await page.evaluate(() => window.said);
    assert.match(said[0][0], /a draft is being made/);
    assert.match(said[1][0], /the final image is being made/);
    assert.equal(said[1][1], 96, "the draft is there by then");
    const size = await page.locator("#rendered").evaluate((image) => [image.naturalWidth, image.naturalHeight]);
    assert.deepEqual(size, [96, 72]);
    const images = await collected(page);
    assert.equal(images.length, 2);
    images.forEach((bytes, i) => writeFileSync(["draft.png", "final.png"][i], bytes));
    assert.ok(await page.locator("#render").isEnabled());
  },

  /** Writes the image to `own.png`, and a scene with the same camera to `own.toml`. */
  async the_viewers_own_camera_is_rendered({ open, scene }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await seek(page, 6);
    for (const key of ["a", "a", "w", "e"]) await page.keyboard.press(key);
    await page.locator("#copy-camera").click();
    writeFileSync("own.toml", `${readFileSync(scene, "utf8")}\n${await page.locator("#camera-text").textContent()}`);
    await page.locator("#camera-dialog button").click();
    await collectImages(page);
    await page.locator("#render").click();
    await page.locator("#render-status", { hasText: /^frame 6, own camera, final$/ }).waitFor();
    writeFileSync("own.png", (await collected(page)).at(-1));
  },

  async without_povray_the_error_is_shown({ open }) {
    const page = await open({ may: [/422/] });
    await until(page, (jabuka) => jabuka.settled);
    await page.keyboard.press("r");
    const problem = page.locator("#render-problem");
    await problem.waitFor({ timeout: LONG });
    process.stdout.write(await problem.innerText());
    assert.ok(await page.locator("#render").isEnabled());
    await page.keyboard.press("Space");
    assert.equal(await page.evaluate(() => window.jabuka.frame), 0);
  },
});
