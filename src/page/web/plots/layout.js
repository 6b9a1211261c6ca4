// Composes a plot of marks: lines, texts, dots and boxes at places in pixels. drawing.js draws them, on a canvas or as SVG.

import { shifted, spread, ticks } from "./axes.js";
import { firstFrom } from "./quantities.js";

/** The smallest width of a plot with names at its curves, in sizes of its letters. */
const WIDTH_FOR_NAMES = 32;
/** Values beyond the largest one have no place. Ranges shorter than the smallest one cannot be divided. */
const [LARGEST, SMALLEST] = [1e300, 1e-300];
/** Points that are nearer to the one before are left out, pixels. */
const FINE = 0.25;

/**
 * Returns the marks of a plot, its area, the shown ranges across (`x`) and up (`y`), and functions between values and places.
 *
 * `plot` has the curves, the label and the unit of each axis (`across` and `up`), a brief label `up`, the shown ranges (`window`), and the `whole`
 * range of time, which a path has not. `equal`: lengths are the same across and up. `styles`: the names of the runs that are compared.
 * `hasNoNames`: the curves need no names. `note`: a sentence in place of curves. On the `paper`, `size` is the height of letters, and `measure`
 * returns the width of a text.
 */
export function layout(plot, paper) {
  const frame = frameOf(plot, paper);
  const behind = [...plot.curves].sort((a, b) => b.which - a.which);
  const curves = behind.flatMap((curve) => drawn(curve, plot, frame, paper.size));
  return { ...frame, ...paper, marks: [...grid(frame), ...curves, ...textsOf(plot, frame, paper)] };
}

/** Returns the area of the curves, what it shows, and the numbers at its axes. */
function frameOf(plot, { width, height, size, measure }) {
  const { curves, across, up } = plot;
  const isWide = width >= WIDTH_FOR_NAMES * size;
  const names = isWide && !plot.hasNoNames ? curves.filter(({ which }) => !which) : [];
  const unit = measure(titled(across, 0));
  const beside = Math.ceil(isWide ? Math.max(...names.map(({ name }) => measure(name) + 0.9 * size), unit + 2.2 * size) : 0.9 * size);
  const top = Math.round(1.8 * size);
  const area = { left: 3 * size, top, width: 1, height: Math.max(1, Math.round(height - 1.75 * size) - top) };
  const fit = () => (area.width = Math.max(1, width - area.left - beside));
  // The width of the numbers at the left follows from the range, which may follow from the width.
  let x, y, levels;
  for (let pass = 0; pass < 3; pass++) {
    fit();
    [x, y] = ranges(plot, area);
    levels = levelsOf(y, area.height, size, up.whole);
    const left = Math.ceil(Math.max(size, ...levels.ticks.map(({ text }) => measure(text))) + 0.8 * size);
    if (left <= area.left && pass) break;
    area.left = left;
  }
  fit();
  const bottom = area.top + area.height;
  return {
    area, x, y, names, levels,
    times: timesOf(x, area.width, width - unit - 1.5 * size - area.left, size, measure),
    toX: (value) => area.left + ((value - x[0]) / (x[1] - x[0])) * area.width,
    toY: (value) => bottom - ((value - y[0]) / (y[1] - y[0])) * area.height,
    atX: (place) => x[0] + ((place - area.left) / area.width) * (x[1] - x[0]),
    atY: (place) => y[0] + ((bottom - place) / area.height) * (y[1] - y[0]),
  };
}

/** Returns the lines at round numbers, and the axes. */
function grid({ area, times, levels, toX, toY }) {
  const [right, bottom] = [area.left + area.width, area.top + area.height];
  const crisp = (place) => Math.round(place - 0.5) + 0.5;
  return [
    ...times.ticks.map(({ at }) => line([crisp(toX(at)), area.top, crisp(toX(at)), bottom], "--line", 1, { faint: true })),
    ...levels.ticks.map(({ at }) => line([area.left, crisp(toY(at)), right, crisp(toY(at))], "--line", 1, { faint: at !== 0 })),
    line([crisp(area.left), area.top, crisp(area.left), crisp(bottom), right, crisp(bottom)], "--axis", 1),
  ];
}

/** Returns all texts, and the lines that explain the lines of compared runs. */
function textsOf(plot, { area, x, y, times, levels, names, toX, toY }, { width, height, size, measure }) {
  const marks = [];
  const boxes = [];
  const put = (text, x, y, align, ink = "--quiet") => {
    const box = boxOf(text, x, y, align);
    boxes.push(box);
    marks.push({ kind: "text", text, x, y, align, ink, box });
  };
  const boxOf = (text, x, y, align) => {
    const left = x - { left: 0, center: 0.5, right: 1 }[align] * measure(text);
    return [left, y - 0.55 * size, left + measure(text), y + 0.55 * size];
  };
  const isFree = ([left, top, right, bottom], gap) => left >= 0 && right <= width && top >= 0 && bottom <= height &&
    boxes.every((box) => right + gap <= box[0] || box[2] + gap <= left || bottom <= box[1] || box[3] <= top);
  /** Puts a number, unless it would cover another text. */
  const number = (text, x, y, align, gap) => isFree(boxOf(text, x, y, align), gap) && put(text, x, y, align);

  const [right, bottom] = [area.left + area.width, area.top + area.height];
  const [above, below] = [0.65 * size, bottom + 1.15 * size];
  const titles = [plot.up.label, plot.up.brief ?? ""].map((label) => titled({ ...plot.up, label }, levels.offset));
  put(titles.find((title) => measure(title) < width) ?? "", 0, above, "left");
  put(titled(plot.across, times.offset), width - 1, below, "right");
  for (const { at, text } of levels.ticks) number(text, area.left - 0.45 * size, toY(at), "right", 1);
  for (const { at, text } of times.ticks) number(text, toX(at), below, "center", 0.6 * size);
  const ends = names.map((curve) => toY(lastIn(curve, x) ?? y[0]));
  const places = spread(ends, 1.15 * size, area.top + 0.3 * size, bottom - 0.3 * size);
  names.forEach(({ name, ink }, k) => put(name, right + 0.5 * size, places[k], "left", ink));
  if (plot.note) put(plot.note, area.left + area.width / 2, area.top + area.height / 2, "center");

  const widths = plot.styles.map((style) => measure(style) + 3 * size);
  let place = right - widths.reduce((sum, wide) => sum + wide, 0) + size;
  if (plot.styles.length < 2 || !isFree([place - 2.2 * size, 0, right, size], size)) return marks;
  plot.styles.forEach((style, which) => {
    marks.push(line([place - 1.9 * size, above, place - 0.4 * size, above], "--ink", ...styleOf(which, size)));
    put(style, place, above, "left");
    place += widths[which];
  });
  return marks;
}

/** Returns the width and the dashes of the lines of a run. */
const styleOf = (which, size) => (which ? [0.1 * size, { dash: [0.45 * size, 0.35 * size] }] : [0.14 * size, {}]);

/** Returns a line through points, which are listed as x, y, x, y, … */
export const line = (points, ink, width, more = {}) => ({ kind: "line", points, ink, width, ...more });

/** Returns the label of an axis, with its unit. */
function titled({ label, unit }, offset) {
  return `${shifted(label, offset)}${unit ? ` (${unit})` : ""}`.trim();
}

/** Returns the ranges across and up. Up, a plot over time fits what is shown. */
function ranges(plot, area) {
  let x = plot.window.x ?? plot.whole ?? padded(extent(plot.curves.map(({ xs }) => xs)));
  let y = plot.window.y ?? padded(extentUp(plot, x));
  if (plot.equal) {
    const scale = Math.max((x[1] - x[0]) / area.width, (y[1] - y[0]) / area.height);
    x = around(x, scale * area.width);
    y = around(y, scale * area.height);
  }
  return [x, y];
}

const around = ([from, to], length) => [(from + to - length) / 2, (from + to + length) / 2];

function extent(all) {
  let [low, high] = [Infinity, -Infinity];
  for (const values of all) {
    for (const value of values) {
      if (value < low && value >= -LARGEST) low = value;
      if (value > high && value <= LARGEST) high = value;
    }
  }
  return [low, high];
}

/** Returns the least and the greatest value of the curves in the range across. Between two frames, curves are straight. */
function extentUp({ curves, whole }, [from, to]) {
  if (!whole) return extent(curves.map(({ ys }) => ys));
  const parts = curves.map(({ xs, ys }) => {
    const [first, end] = [firstFrom(xs, from), firstFrom(xs, to)];
    const at = (place, k) => (k > 0 && k < xs.length ? ys[k - 1] + ((place - xs[k - 1]) / (xs[k] - xs[k - 1])) * (ys[k] - ys[k - 1]) : NaN);
    return [at(from, first), ...ys.subarray(first, end), at(to, end), xs[end] === to ? ys[end] : NaN];
  });
  return extent(parts);
}

/** Returns a range with room at both ends. Values that differ only by rounding errors are equal. */
function padded([low, high]) {
  if (!(high >= low)) return [0, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low > Math.max(SMALLEST, 1e-13 * size)) return [low - 0.06 * (high - low), high + 0.06 * (high - low)];
  const room = size > SMALLEST ? 0.1 * size : 1;
  return [(low + high) / 2 - room, (low + high) / 2 + room];
}

/** Returns at least two round values up, if they have room. */
function levelsOf([low, high], height, size, whole) {
  // The numbers of a low plot stand closer together than those of a high one.
  const [closest, usual] = [1.55, 3.2].map((apart) => Math.floor(height / (apart * size)));
  const most = Math.max(1, Math.min(closest, Math.max(5, usual)));
  const found = ticks(low, high, most, { whole });
  return found.ticks.length > 1 ? found : ticks(low, high, 2 * most, { whole });
}

/**
 * Returns as many round values across as have room for their numbers. The unit covers what is beyond `free`. If that leaves less than two numbers,
 * they stand closer together.
 */
function timesOf([from, to], width, free, size, measure) {
  const place = (value) => ((value - from) / (to - from)) * width;
  let found;
  for (const gap of [1.2, 0.5]) {
    for (let most = Math.max(6, Math.floor(width / (5 * size))); most > 0; most--) {
      found = ticks(from, to, most, { digits: 7 });
      if (place(from + found.step) >= Math.max(...found.ticks.map(({ text }) => measure(text))) + gap * size) break;
    }
    if (found.ticks.filter(({ at, text }) => place(at) + measure(text) / 2 < free).length > 1) break;
  }
  return found;
}

/** Returns the lines of a curve. An absent body has no curve, so the curve is interrupted. A point without neighbors is a dot. */
function drawn({ which, ink, xs, ys }, { whole }, { x, toX, toY }, size) {
  const [first, end] = whole ? [Math.max(0, firstFrom(xs, x[0]) - 1), Math.min(xs.length, firstFrom(xs, x[1]) + 1)] : [0, xs.length];
  const [wide, dashes] = styleOf(which, size);
  const marks = [];
  let points = [];
  const finish = () => {
    if (points.length > 2) marks.push(line(points, ink, wide, { ...dashes, clip: true }));
    else if (points.length) marks.push({ kind: "dot", x: points[0], y: points[1], r: 0.2 * size, ink });
    points = [];
  };
  for (let k = first; k < end; k++) {
    const [a, b] = [toX(xs[k]), toY(ys[k])];
    if (!Number.isFinite(a) || !Number.isFinite(b)) {
      finish();
      continue;
    }
    const near = points.length && Math.abs(a - points.at(-2)) + Math.abs(b - points.at(-1)) < FINE;
    if (!near || (k + 1 === end && points.length === 2)) points.push(a, b);
  }
  finish();
  return marks;
}

/** Returns the last value of a curve in a range of time. */
function lastIn({ xs, ys }, [, to]) {
  for (let k = Math.min(xs.length, firstFrom(xs, to) + 1) - 1; k >= 0; k--) if (!Number.isNaN(ys[k])) return ys[k];
  return undefined;
}
