// Vectors are arrays of three numbers, quaternions are x y z w, matrices are 4 x 4 in column-major order.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** Returns the unit vector along `a`, or `otherwise` if `a` has no direction. */
export function unit(a, otherwise = [0, 0, 0]) {
  const l = length(a);
  return l > 0 && Number.isFinite(l) ? times(a, 1 / l) : otherwise;
}

/** Rotates a vector by a quaternion. */
export function turned([x, y, z, w], v) {
  const t = times(cross([x, y, z], v), 2);
  return add(add(v, times(t, w)), cross([x, y, z], t));
}

export function product(a, b) {
  const out = new Float64Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      out[4 * column + row] = sum;
    }
  }
  return out;
}

/** Returns the matrix from world coordinates to those of a camera at `eye`, which looks along its own -z. */
export function lookAt(eye, { right, up, back }) {
  return new Float64Array([
    right[0], up[0], back[0], 0,
    right[1], up[1], back[1], 0,
    right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1,
  ]);
}

/**
 * Returns the axes of a camera that looks from `eye` to `aim`. The direction `sky` points up; without it, the camera is upright. For a vertical
 * view, x points to the right, as in the scripts.
 */
export function axes(eye, aim, sky) {
  const back = unit(sub(eye, aim), [0, 0, 1]);
  const vertical = Math.max(Math.abs(back[0]), Math.abs(back[2])) < 1e-6 * Math.abs(back[1]);
  const right = vertical && !sky ? [1, 0, 0] : unit(cross(sky || [0, 1, 0], back), [1, 0, 0]);
  return { right, up: cross(back, right), back };
}

export function perspective(tangentX, tangentY, near, far) {
  const m = new Float64Array(16);
  m[0] = 1 / tangentX;
  m[5] = 1 / tangentY;
  m[10] = (far + near) / (near - far);
  m[11] = -1;
  m[14] = (2 * far * near) / (near - far);
  return m;
}

export function orthographic(halfX, halfY, near, far) {
  const m = new Float64Array(16);
  m[0] = 1 / halfX;
  m[5] = 1 / halfY;
  m[10] = 2 / (near - far);
  m[14] = (far + near) / (near - far);
  m[15] = 1;
  return m;
}

/** Projects a point into the picture. Returns x and y from -1 to 1, and the homogeneous coordinate w. */
export function projected(matrix, [x, y, z]) {
  const row = (i) => matrix[i] * x + matrix[4 + i] * y + matrix[8 + i] * z + matrix[12 + i];
  const w = row(3);
  return { x: row(0) / w, y: row(1) / w, w };
}

/** Returns the pixel of the page at which a view shows a point of the world. Undefined behind the camera. */
export function pixelOf(view, { center, size }, point) {
  const { x, y, w } = projected(view.clip, times(sub(point, center), 1 / size));
  return w > 0 ? [((x + 1) / 2) * view.width, ((1 - y) / 2) * view.height] : undefined;
}

/** Formats a number with a few significant digits. */
export function short(number, digits = 4) {
  if (!Number.isFinite(number)) return "–";
  const size = Math.abs(number);
  if (size !== 0 && (size < 1e-4 || size >= 1e6)) {
    return number.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e").replace(/-/g, "−");
  }
  return String(Number(number.toPrecision(digits))).replace("-", "−");
}

/** Converts a color from sRGB to linear light. */
export const linear = (color) => color.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));

/** Converts a color from linear light to sRGB. */
export const encoded = (color) => color.map((c) => (c <= 0.0031308 ? c * 12.92 : 1.055 * c ** (1 / 2.4) - 0.055));

export const css = (color) => `rgb(${color.map((c) => Math.round(255 * Math.min(1, Math.max(0, c)))).join(" ")})`;

/** Returns true if a body is present. The pose of an absent body consists of NaNs. */
export function isThere(pose) {
  return !Number.isNaN(pose[0]);
}
