// What is in the picture: colors at places of the world.

import { drawn } from "./browser.mjs";

/** Where a place of the world comes to in the picture, in pixels of the page from the corner of the canvas. */
export async function projected(page, [x, y, z]) {
  await drawn(page);
  const { clip, width, height, center, size } = await page.evaluate(() => window.jabuka.view);
  const point = [(x - center[0]) / size, (y - center[1]) / size, (z - center[2]) / size, 1];
  const row = (i) => point.reduce((sum, coordinate, k) => sum + clip[4 * k + i] * coordinate, 0);
  return [((row(0) / row(3) + 1) / 2) * width, ((1 - row(1) / row(3)) / 2) * height];
}

/** Where the middle of a body is in the picture. */
export async function place(page, body) {
  await drawn(page);
  return projected(page, (await page.evaluate((body) => window.jabuka.pose(body), body)).location);
}

/** The color of a pixel of the picture, red, green and blue from 0 to 255. */
export async function color(page, [x, y]) {
  return page.evaluate(async ([x, y]) => {
    await window.jabuka.whenDrawn();
    const canvas = document.getElementById("picture");
    const gl = canvas.getContext("webgl2");
    const scale = canvas.width / canvas.clientWidth;
    const bytes = new Uint8Array(4);
    gl.readPixels(Math.floor(x * scale), canvas.height - 1 - Math.floor(y * scale), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return Array.from(bytes.subarray(0, 3));
  }, [x, y]);
}

/** A number that another picture does not have. */
export async function digest(page) {
  return page.evaluate(async () => {
    await window.jabuka.whenDrawn();
    const canvas = document.getElementById("picture");
    const gl = canvas.getContext("webgl2");
    const bytes = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes.reduce((sum, byte) => (Math.imul(sum, 31) + byte) | 0, 7);
  });
}

/** The canvas, on the page. */
export const box = (page) => page.locator("#picture").boundingBox();

/** Clicks at a place of the picture. */
export async function click(page, [x, y]) {
  const { x: left, y: top } = await box(page);
  await page.mouse.click(left + x, top + y);
}

export const isRed = ([r, g, b]) => r > 90 && r > 1.6 * g && r > 1.6 * b;
export const isBlue = ([r, g, b]) => b > 120 && b > 1.1 * r && b >= g;
