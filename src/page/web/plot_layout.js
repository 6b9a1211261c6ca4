// Composes a plot of marks: lines, texts, dots and boxes at places in pixels. plot_drawing.js draws them, on a canvas or as SVG.

import { shifted, spread, ticks } from "./plot_axes.js";
import { firstFrom } from "./plot_quantities.js";

/** The smallest width of a plot with names at its curves, in sizes of its letters. */
const WIDTH_FOR_NAMES = 32;
/** Values beyond the largest one have no place. Ranges shorter than the smallest one cannot be divided. */
const [LARGEST, SMALLEST] = [1e300, 1e-300];
/** Points that are nearer to the one before are left out, pixels. */
const FINE = 0.25;

/**
 * Returns the marks of a plot, its area, the shown ranges across (`x`) and up (`y`), and functions between values and places.
 *
 * `plot` has the curves, the name (also a brief one) and the unit `across` and `up`, the shown ranges (`window`), and the `whole` range across. `equal`: lengths are the
 * same across and up. `styles`: what the lines of the first and the second run stand for. `note`: a sentence in place of curves.
 * `size` is the height of letters, and `measure` returns the width of a text.
 */
export function layout(plot, { width, height, size, measure }) {
  const { curves, across, up } = plot;
  const texts = [];
  const put = (text, x, y, align, more = {}) => {
    const wide = measure(text);
    const left = x - { left: 0, center: wide / 2, right: wide }[align];
    texts.push({ kind: "text", text, x, y, align, ink: "--quiet", ...more, box: [left, y - 0.55 * size, left + wide, y + 0.55 * size] });
  };
  const isFree = ([left, top, right, bottom], gap) => left >= 0 && right <= width && top >= 0 && bottom <= height &&
    texts.every(({ box }) => right + gap <= box[0] || box[2] + gap <= left || bottom <= box[1] || box[3] <= top);

  const isWide = width >= WIDTH_FOR_NAMES * size;
  const names = isWide && !plot.hasNoNames ? curves.filter(({ which }) => !which) : [];
  const beside = Math.ceil(isWide ? Math.max(...names.map(({ name }) => measure(name) + 0.9 * size), measure(across.label) + 2.2 * size) : 0.9 * size);
  const top = Math.round(1.8 * size);
  const area = { top, height: Math.max(1, Math.round(height - 1.75 * size) - top), left: 3 * size, width: 1 };
  // The width of the numbers at the left follows from the range, which may follow from the width.
  let x, y, levels;
  for (let pass = 0; pass < 3; pass++) {
    area.width = Math.max(1, width - area.left - beside);
    [x, y] = ranges(plot, area);
    levels = levelsOf(y, area.height, size, up.whole);
    const left = Math.ceil(Math.max(size, ...levels.ticks.map(({ text }) => measure(text))) + 0.8 * size);
    if (left <= area.left && pass) break;
    area.left = left;
  }
  area.width = Math.max(1, width - area.left - beside);
  const [right, bottom] = [area.left + area.width, area.top + area.height];
  const toX = (value) => area.left + ((value - x[0]) / (x[1] - x[0])) * area.width;
  const toY = (value) => bottom - ((value - y[0]) / (y[1] - y[0])) * area.height;
  const free = width - measure(across.label) - 1.5 * size - area.left;
  const times = timesOf(x, area.width, free, size, measure);

  const lines = [];
  const crisp = (place) => Math.round(place - 0.5) + 0.5;
  for (const { at } of times.ticks) lines.push(line([crisp(toX(at)), area.top, crisp(toX(at)), bottom], "--line", 1, { faint: true }));
  for (const { at } of levels.ticks) lines.push(line([area.left, crisp(toY(at)), right, crisp(toY(at))], "--line", 1, { faint: at !== 0 }));
  lines.push(line([crisp(area.left), area.top, crisp(area.left), crisp(bottom), right, crisp(bottom)], "--axis", 1));
  for (const curve of [...curves].sort((a, b) => b.which - a.which)) lines.push(...drawn(curve, plot, x, toX, toY, size));

  // The units come first: a number that would cover one is left out.
  const titles = [up.label, up.brief ?? ""].map((label) => titled({ ...up, label }, levels.offset));
  put(titles.find((title) => measure(title) < width) ?? "", 0, 0.65 * size, "left");
  const unit = shifted(across.label.replace(/ \(.*/, ""), times.offset) + (/ \(.*/.exec(across.label)?.[0] ?? "");
  const below = bottom + 1.15 * size;
  put(unit, width - 1, below, "right");
  for (const { at, text } of levels.ticks) number(text, area.left - 0.45 * size, toY(at), "right", 1);
  for (const { at, text } of times.ticks) number(text, toX(at), below, "center", 0.6 * size);
  function number(text, x, y, align, gap) {
    put(text, x, y, align);
    const mark = texts.pop();
    if (isFree(mark.box, gap)) texts.push(mark);
  }
  if (plot.styles.length > 1) key(plot.styles, right, size, measure, put, lines, isFree);
  const ends = names.map((curve) => toY(lastIn(curve, x) ?? y[0]));
  const places = spread(ends, 1.15 * size, area.top + 0.3 * size, bottom - 0.3 * size);
  names.forEach(({ name, ink }, k) => put(name, right + 0.5 * size, places[k], "left", { ink }));
  if (plot.note) put(plot.note, area.left + area.width / 2, area.top + area.height / 2, "center");
  return {
    area, x, y, toX, toY, width, height, size, marks: [...lines, ...texts],
    atX: (place) => x[0] + ((place - area.left) / area.width) * (x[1] - x[0]),
    atY: (place) => y[0] + ((bottom - place) / area.height) * (y[1] - y[0]),
  };
}

/** Returns a line through points, which are listed as x, y, x, y, … */
export const line = (points, ink, width, more = {}) => ({ kind: "line", points, ink, width, ...more });

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
function drawn({ which, ink, xs, ys }, { whole }, x, toX, toY, size) {
  const [first, end] = whole ? [Math.max(0, firstFrom(xs, x[0]) - 1), Math.min(xs.length, firstFrom(xs, x[1]) + 1)] : [0, xs.length];
  const style = { clip: true, dash: which ? [0.45 * size, 0.35 * size] : undefined };
  const marks = [];
  let points = [];
  const finish = () => {
    if (points.length > 2) marks.push(line(points, ink, (which ? 0.1 : 0.14) * size, style));
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

/** Says above the plot which run has which lines. */
function key(styles, right, size, measure, put, lines, isFree) {
  const y = 0.65 * size;
  const widths = styles.map((style) => measure(style) + 3 * size);
  let x = right - widths.reduce((sum, wide) => sum + wide, 0) + size;
  if (!isFree([x - 2.2 * size, 0, right, size], size)) return;
  styles.forEach((style, which) => {
    lines.push(line([x - 1.9 * size, y, x - 0.4 * size, y], "--ink", (which ? 0.1 : 0.14) * size, { dash: which ? [0.45 * size, 0.35 * size] : undefined }));
    put(style, x, y, "left");
    x += widths[which];
  });
}
