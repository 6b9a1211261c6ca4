// Measures the time from the start of `jabuka preview` to the first frame on the page, in a headless browser that is already open.
//
//   cargo build --release && tests/preview/browser ../../benches/preview.mjs target/release/jabuka scenes/parabola.toml

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { newPage, open } from "../tests/preview/browser.mjs";
import { launch } from "../tests/preview/launch.mjs";

const [jabuka, scene] = process.argv.slice(2).map((path) => resolve(path));
const folder = mkdtempSync(join(tmpdir(), "jabuka-"));
const browser = await launch();
try {
  for (let n = 0; n < 5; n++) {
    const page = await newPage(browser, { size: { width: 1280, height: 800 } });
    const start = performance.now();
    const server = spawn(jabuka, ["preview", scene, "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "ignore"] });
    try {
      const [address] = await once(server.stdout, "data");
      const served = performance.now();
      await open(page, String(address).trim());
      const drawn = performance.now();
      console.log(`served after ${((served - start) / 1000).toFixed(3)} s, drawn after ${((drawn - start) / 1000).toFixed(3)} s`);
    } finally {
      server.kill();
      await page.context().close();
    }
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
