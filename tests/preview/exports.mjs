// Tests of what the page of the preview saves.

import assert from "node:assert/strict";
import { copyFileSync } from "node:fs";
import { tests, until } from "./browser.mjs";

await tests({
  /** Saves each file below the name that the page gives it; the Rust test compares them with those of the program. */
  async all_kinds_of_files_are_saved({ open }) {
    const page = await open();
    await until(page, (jabuka) => jabuka.settled);
    await page.getByRole("button", { name: "Save" }).click();
    await page.locator("#film-size").selectOption("640 360");
    await page.locator("#film-format").selectOption("webm");
    await page.locator("#film-to").fill("2");
    const names = [];
    for (const kind of ["picture", "film", "model", "table", "page", "scripts"]) {
      const download = page.waitForEvent("download");
      await page.locator(`#save-${kind}`).click();
      const name = (await download).suggestedFilename();
      copyFileSync(await (await download).path(), name);
      names.push(name);
      await page.locator("#save-said", { hasText: `${name} is saved` }).waitFor();
    }
    assert.deepEqual(names, ["scene_0.png", "scene.webm", "scene.glb", "scene.csv", "scene.html", "scene.zip"]);
  },
});
