// Collects everything that is drawn as lines or thin areas: trails, arrows, springs, joints, grids, axes, swept areas, and the outline of the
// scene's camera.

import { add, cross, dot, isThere, length, sub, times, turned, unit } from "../math.js";

/** The lines of a picture, and its thin areas. Each line has two ends, a radius at each end, and a color in sRGB. Lengths are in meters. */
export class Lines {
  constructor() {
    this.numbers = [];
    /** The corners of the triangles of areas: for each, three coordinates and a color. */
    this.corners = [];
  }

  /** The lines that nothing hides. */
  get inFront() {
    return (this.front ??= new Lines());
  }

  /** Adds an area: triangles from the first point to each two neighboring others. */
  addArea([first, ...points], opacity, color) {
    for (let i = 1; i < points.length; i++) {
      for (const point of [first, points[i - 1], points[i]]) this.corners.push(...point, ...color, opacity);
    }
  }

  add(from, to, radius, color, radiusAtEnd = radius, alpha = 1) {
    this.numbers.push(...from, radius, ...to, radiusAtEnd, ...color, alpha);
  }

  get count() {
    return this.numbers.length / 12;
  }

  /** Returns the corners of all areas for the shaders, relative to the center and the size of the scene. */
  packedCorners({ center, size }) {
    return Float32Array.from(this.corners, (number, i) => (i % 7 < 3 ? (number - center[i % 7]) / size : number));
  }

  /** Returns the numbers of all lines for the shaders, relative to the center and the size of the scene. */
  packed({ center, size }) {
    const out = new Float32Array(this.numbers);
    for (let i = 0; i < out.length; i += 12) {
      for (let k = 0; k < 3; k++) {
        out[i + k] = (this.numbers[i + k] - center[k]) / size;
        out[i + 4 + k] = (this.numbers[i + 4 + k] - center[k]) / size;
      }
      out[i + 3] /= size;
      out[i + 7] /= size;
    }
    return out;
  }
}

/** Adds an arrow, with a head as in the POV-Ray templates. */
function arrow(lines, { from, to, radius, color }) {
  const along = sub(to, from);
  const shaft = Math.min(radius, length(along) / 14);
  const neck = sub(to, times(unit(along), 9 * shaft));
  lines.add(from, neck, shaft, color);
  lines.add(neck, to, 3.2 * shaft, color, 0);
}

/** How a thing of each form is drawn, with the same shape as in the scripts. */
const DRAWN = {
  ball: (lines, { at, radius, color }) => lines.add(at, at, radius, color),
  rod: (lines, { ends, radius, color }) => lines.add(...ends, radius, color),
  rope: (lines, { points, radius, color }) => points.slice(1).forEach((point, i) => lines.add(points[i], point, radius, color)),
  coil: (lines, { ends, radius, wire, turns, color }) => coil(lines, ends, radius, wire, turns, color),
  arrow,
  axes,
  area: (all, { points, opacity, color }) => all.addArea(points, opacity, color),
  lines: (all, { lines, color }) => lines.forEach(({ from, to, radius }) => all.add(from, to, radius, color)),
};

/** Adds a thing that is drawn beside the bodies. */
export function thing(lines, each) {
  DRAWN[each.form](lines, each);
}

/** Adds a coil around the line between two points, as in the POV-Ray templates. */
function coil(lines, [a, b], radius, wire, turns, color) {
  const axis = sub(b, a);
  const sideways = unit(cross(axis, Math.abs(unit(axis)[2]) < 0.98 ? [0, 0, 1] : [1, 0, 0]), [1, 0, 0]);
  const across = times(sideways, radius);
  const upward = times(unit(cross(sideways, axis), [0, 1, 0]), radius);
  const begin = add(a, times(axis, 0.08));
  lines.add(a, begin, wire, color);
  let last = begin;
  for (let i = 0; i <= 14 * turns; i++) {
    const angle = (2 * Math.PI * i) / 14;
    const next = add(add(add(begin, times(axis, (0.84 * i) / (14 * turns))), times(across, Math.cos(angle))), times(upward, Math.sin(angle)));
    lines.add(last, next, wire, color);
    last = next;
  }
  const end = sub(b, times(axis, 0.08));
  lines.add(last, end, wire, color);
  lines.add(end, b, wire, color);
}

/** The colors of the x, y and z axes, in sRGB. */
export const AXES = [[0.8, 0.1, 0.12], [0.1, 0.54, 0.2], [0.14, 0.3, 0.82]];

function axes(lines, { location, orientation, length: arm }) {
  AXES.forEach((color, i) => {
    const direction = turned(orientation, [0, 1, 2].map((k) => (k === i ? arm : 0)));
    lines.add(location, add(location, times(direction, 0.8)), 0.03 * arm, color);
    lines.add(add(location, times(direction, 0.76)), add(location, direction), 0.078 * arm, color, 0);
  });
}

/**
 * Adds the trail of a body up to the present position in the film, as far as its frames have been fetched. If its color follows a value,
 * `palette` has the colors of its map, and `shades` the index of the color at each `every`-th frame.
 */
export function trail(lines, run, { body, radius, color, tail = 1, palette, shades, every }, position, most) {
  const { duration, at = [0, 0, 0] } = run.description.bodies[body].trail ?? {};
  const isCentre = at.every((number) => number === 0);
  const pointOf = (pose) => (isCentre ? pose.slice(0, 3) : add(pose.slice(0, 3), turned(pose.slice(3), at)));
  const first = duration ? Math.max(0, run.positionAt(run.timeAt(position) - duration)) : 0;
  const colorAt = (frame) => (palette ? palette[shades[Math.min(Math.round(frame / every), shades.length - 1)]] ?? color : color);
  const [points, colors] = [[], []];
  const stride = Math.max(1, Math.ceil((position - first) / Math.min(1500, most)));
  let away = false;
  for (let frame = Math.ceil(first); frame < position; frame += stride) {
    const poses = run.poses(frame);
    const place = poses && pointOf(poseIn(poses, run.bodies, body));
    const wasAway = away;
    away = place !== undefined && !isThere(place);
    // The trail restarts when an absent body appears again.
    if (!place || (wasAway && !away)) points.length = colors.length = 0;
    if (place && !away) {
      points.push(place);
      colors.push(colorAt(frame));
    }
  }
  const here = run.posesAt(position)?.(body);
  if (here && isThere(here)) {
    if (away) points.length = colors.length = 0;
    points.push(pointOf(here));
    colors.push(colorAt(position));
  }
  const places = points.length * 8 < most ? bends(points) : points.map((_, i) => i);
  const smooth = places.map((place) => onCurve(points, place));
  for (let i = 1; i < smooth.length; i++) {
    const width = (k) => radius * (tail + ((1 - tail) * k) / (smooth.length - 1));
    // A piece has the color of its middle.
    const middle = (places[i - 1] + places[i]) / 2;
    const [from, to] = [colors[Math.floor(middle)], colors[Math.ceil(middle)]];
    const mixed = from === to ? from : from.map((part, k) => part + (middle % 1) * (to[k] - part));
    lines.add(smooth[i - 1], smooth[i], width(i - 1), mixed, width(i));
  }
}

/** Returns the location and orientation of a body from the poses of a frame. */
function poseIn(poses, bodies, body) {
  const turn = 3 * bodies + 4 * body;
  return [...poses.subarray(3 * body, 3 * body + 3), ...poses.subarray(turn, turn + 4)];
}

/** Returns the four points of a polyline around its piece from point `i - 1` to point `i`. */
function around(points, i) {
  return [points[Math.max(0, i - 2)], points[i - 1], points[i], points[Math.min(points.length - 1, i + 1)]];
}

/** Returns the places at which a polyline needs points to look round, as fractional indices. It has more of them where it bends. */
function bends(points) {
  const places = points.map((_, i) => i);
  if (points.length < 3 || points.length > 800) return places;
  const out = [0];
  for (let i = 1; i < points.length; i++) {
    const [a, b, c, d] = around(points, i);
    const [u, v, w] = [sub(b, a), sub(c, b), sub(d, c)];
    const bend = Math.max(angle(u, v), angle(v, w));
    const pieces = bend < Math.PI / 2 ? Math.max(1, Math.min(8, Math.ceil(bend / 0.06))) : 1;
    for (let k = 1; k <= pieces; k++) out.push(i - 1 + k / pieces);
  }
  return out;
}

/** Returns the point at a fractional index of a polyline, on a Catmull–Rom spline through all of its points. */
function onCurve(points, place) {
  const s = place % 1;
  if (s === 0) return points[place];
  const [a, b, c, d] = around(points, Math.ceil(place));
  return b.map((_, j) => 0.5 * (2 * b[j] + (c[j] - a[j]) * s + (2 * a[j] - 5 * b[j] + 4 * c[j] - d[j]) * s * s + (3 * b[j] - a[j] - 3 * c[j] + d[j]) * s ** 3));
}

function angle(a, b) {
  const [p, q] = [unit(a), unit(b)];
  return Math.acos(Math.max(-1, Math.min(1, dot(p, q)))) || 0;
}

/** Adds the outline of the scene's camera, seen from another viewpoint: a pyramid from the camera to the edges of its picture. */
export function camera(lines, { location, right, up, back, tangentX, tangentY, depth }, radius) {
  const color = [0.95, 0.62, 0.1];
  const corner = (x, y) => add(add(sub(location, times(back, depth)), times(right, x * tangentX * depth)), times(up, y * tangentY * depth));
  const corners = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  corners.forEach((point, i) => {
    lines.add(location, point, radius, color);
    lines.add(point, corners[(i + 1) % 4], radius, color);
  });
}
