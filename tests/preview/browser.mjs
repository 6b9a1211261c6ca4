// A real, headless browser, which notes whatever goes wrong on a page.

import { existsSync } from "node:fs";
import { createRequire } from "node:module";

const { chromium } = createRequire(`${process.env.JABUKA_MODULES}/`)("playwright-core");

/** The browser of the system: the first that is there. */
const PROGRAMS = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome", "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome"];

/** WebGL by the processor, so that it is the same everywhere; nothing that calls home. */
const OPTIONS = [
  "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

export async function launch() {
  const executablePath = process.env.JABUKA_BROWSER ?? PROGRAMS.find(existsSync);
  return chromium.launch({ executablePath, headless: true, args: OPTIONS });
}

/** A page that remembers its errors and all that it has asked for. */
export async function newPage(browser, { size = { width: 1280, height: 800 }, ...more } = {}) {
  const context = await browser.newContext({ viewport: size, ...more });
  const page = await context.newPage();
  page.wrong = [];
  page.asked = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && page.wrong.push(message.text()));
  page.on("pageerror", (error) => page.wrong.push(String(error)));
  page.on("request", (request) => page.asked.push(request.url()));
  return page;
}

/** Waits until the frame that is wanted is drawn. */
export const drawn = (page) => page.evaluate(async () => (await window.jabuka.whenDrawn(), window.jabuka.frame));

/** The color of a pixel of the picture, red, green and blue from 0 to 255. */
export async function pixel(page, x, y) {
  return page.evaluate(([x, y]) => {
    const canvas = document.getElementById("picture");
    const gl = canvas.getContext("webgl2");
    const scale = canvas.width / canvas.clientWidth;
    const bytes = new Uint8Array(4);
    gl.readPixels(Math.round(x * scale), canvas.height - 1 - Math.round(y * scale), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return Array.from(bytes.subarray(0, 3));
  }, [x, y]);
}
