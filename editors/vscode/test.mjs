// Uses the extension in code-server, as a user would: `test` starts it.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { launch } from "../../tests/preview/launch.mjs";

const [address, folder] = process.argv.slice(2);
/** The time limit for each wait, ms. */
const LONG = 60_000;

const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1300, height: 800 } });
page.setDefaultTimeout(LONG);

/** Waits until a condition holds. */
async function until(what, is) {
  const end = Date.now() + LONG;
  while (!(await is())) {
    assert.ok(Date.now() < end, `in vain: ${what}`);
    await page.waitForTimeout(200);
  }
}

async function command(name) {
  await page.keyboard.press("F1");
  await page.keyboard.type(name);
  await page.locator(".quick-input-list-row", { hasText: name }).first().click();
}

try {
  await page.goto(`${address}/?folder=${encodeURIComponent(folder)}`);
  await page.locator(".explorer-item", { hasText: "throw.toml" }).dblclick();
  await page.locator(".squiggly-error").first().waitFor();

  // The slip is mended by its quick fix.
  await page.locator(".view-line", { hasText: "velosity" }).click();
  await page.keyboard.press("Home");
  await page.keyboard.press("Control+.");
  await page.getByText("Write velocity").waitFor();
  await page.keyboard.press("Enter");
  await page.locator(".view-line", { hasText: "velocity" }).waitFor();
  await page.keyboard.press("Control+S");
  await until("the file is mended", () => readFileSync(join(folder, "throw.toml"), "utf8").includes("\nvelocity = [1, 5, 0]\n"));
  await until("no error is left", async () => (await page.locator(".squiggly-error").count()) === 0);

  // The scene moves beside its text, and follows it after each save.
  await command("jabuka: Show the Scene");
  const view = async () => {
    for (const frame of page.frames()) {
      const frames = await frame.evaluate(() => (window.jabuka?.drawn.count ? window.jabuka.frames : 0)).catch(() => 0);
      if (frames) return frames;
    }
    return 0;
  };
  await until("the scene of one second is drawn", async () => (await view()) === 26);
  await page.locator(".view-line", { hasText: "duration" }).click();
  await page.keyboard.press("End");
  await page.keyboard.type(".4");
  await page.keyboard.press("Control+S");
  await until("the scene of 1.4 seconds is drawn", async () => (await view()) === 36);

  // A moment is rendered.
  await command("jabuka: Render a Moment");
  await page.locator(".quick-input-box input").fill("0.5");
  await page.keyboard.press("Enter");
  await page.getByRole("tab", { name: /throw_0\.5s\.png/ }).waitFor();
} catch (error) {
  console.error("The editor shows:", (await page.locator("body").innerText()).slice(0, 2000));
  throw error;
} finally {
  await browser.close();
}
