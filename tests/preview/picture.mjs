// Reads the picture: positions of points and bodies, and colors of pixels.

import { drawn } from "./browser.mjs";

/** Returns the position of a point of the scene in the picture, in CSS pixels from the upper left corner of the canvas. */
export async function projected(page, [x, y, z]) {
  await drawn(page);
  const { clip, width, height, center, size } = await page.evaluate(() => window.jabuka.view);
  const point = [(x - center[0]) / size, (y - center[1]) / size, (z - center[2]) / size, 1];
  const row = (i) => point.reduce((sum, coordinate, k) => sum + clip[4 * k + i] * coordinate, 0);
  return [((row(0) / row(3) + 1) / 2) * width, ((1 - row(1) / row(3)) / 2) * height];
}

/** Returns the position of a body's center in the picture. */
export async function place(page, body) {
  await drawn(page);
  return projected(page, (await page.evaluate((body) => window.jabuka.pose(body), body)).location);
}

/** Returns the color of a pixel of the picture: red, green and blue, 0 to 255. */
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

/** Returns a digest of the picture, to tell whether two pictures are equal. */
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

/** Returns the bounding box of the canvas on the page. */
export const box = (page) => page.locator("#picture").boundingBox();

/** Clicks at a position of the picture. */
export async function click(page, [x, y]) {
  const { x: left, y: top } = await box(page);
  await page.mouse.click(left + x, top + y);
}

export const isRed = ([r, g, b]) => r > 90 && r > 1.6 * g && r > 1.6 * b;
export const isBlue = ([r, g, b]) => b > 120 && b > 1.1 * r && b >= g;
