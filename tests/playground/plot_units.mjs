// Tests of the parts of plots that need no page: round numbers, places of names, ranges, differences and tables.

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const { buildSync } = createRequire(join(root, "playground/"))("esbuild");
const names = ["axes", "window", "quantities", "layout", "table", "drawing"];
const contents = names.map((name) => `export * from "./plots/${name}.js";`).join("\n");
const { outputFiles } = buildSync({ stdin: { contents, resolveDir: join(root, "src/page/web") }, bundle: true, format: "esm", write: false });
const { QUANTITIES, against, asSvg, curvesOf, firstFrom, followed, layout, moved, nearest, shifted, spread, tableOf, ticks, zoomed } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString("base64")}`);

/** Returns random numbers from 0 to 1, the same in each run. */
function random(seed) {
  let state = seed;
  return () => (state = (state * 16807) % 2147483647) / 2147483647;
}
const texts = (...of) => ticks(...of).ticks.map(({ text }) => text);
const read = (text) => Number(text.replace(/−/g, "-"));

test("numbers at axes are round", () => {
  assert.deepEqual(texts(0, 10, 5), ["0", "2", "4", "6", "8", "10"]);
  assert.deepEqual(texts(-1.06, 1.06, 4), ["−1", "0", "1"]);
  assert.deepEqual(texts(0, 1, 4), ["0.0", "0.5", "1.0"]);
  assert.deepEqual(texts(0.3, 0.35, 5), ["0.30", "0.31", "0.32", "0.33", "0.34", "0.35"]);
  assert.deepEqual(texts(0, 1.7, 8, { whole: true }), ["0", "1"]);
});

test("very large and very small numbers have exponents", () => {
  assert.deepEqual(texts(0, 1.7e-9, 4), ["0", "5e−10", "1e−9", "1.5e−9"]);
  assert.deepEqual(texts(-3e12, 3e12, 3), ["−2e12", "0", "2e12"]);
  assert.deepEqual(texts(0, 900000, 3), ["0", "500000"]);
});

test("numbers that hardly differ are written as differences", () => {
  const { offset, ticks: found } = ticks(1000.00012, 1000.00034, 4);
  assert.equal(offset, 1000);
  assert.deepEqual(found.map(({ text }) => text), ["2e−4", "3e−4"]);
  assert.equal(shifted("energy", 1000), "energy − 1000");
  assert.equal(shifted("energy", -2.5e-9), "energy + 2.5e−9");
  assert.equal(shifted("energy", 0), "energy");
});

test("numbers at any axis are in its range, and few", () => {
  const next = random(1);
  for (let k = 0; k < 20_000; k++) {
    const length = 10 ** (24 * next() - 12);
    const low = (next() - 0.5) * length * 10 ** (12 * next());
    const most = 1 + Math.floor(12 * next());
    const { offset, ticks: found } = ticks(low, low + length, most);
    assert.ok(found.length <= most + 1, `${low} + ${length}: ${found.length} of ${most}`);
    assert.equal(new Set(found.map(({ text }) => text)).size, found.length, `${low} + ${length}`);
    for (const { at, text } of found) {
      assert.ok(at >= low - 1e-6 * length && at <= low + length * (1 + 1e-6), `${at} is not in ${low} + ${length}`);
      assert.ok(Math.abs(offset + read(text) - at) <= 1e-6 * length, `${text} + ${offset} at ${at}`);
      assert.ok(text.length <= 10, `${text} of ${low} + ${length}`);
    }
  }
});

test("labels do not cover each other and stay near", () => {
  assert.deepEqual(spread([50, 20], 10, 0, 100), [50, 20]);
  assert.deepEqual(spread([50, 50, 50], 10, 0, 100), [40, 50, 60]);
  assert.deepEqual(spread([2, 1], 10, 0, 100), [10, 0]);
  assert.deepEqual(spread([99, 100], 10, 0, 100), [90, 100]);
  const next = random(2);
  for (let k = 0; k < 2000; k++) {
    const wanted = Array.from({ length: 1 + Math.floor(6 * next()) }, () => 140 * next() - 20);
    const places = spread(wanted, 12, 0, 100);
    const sorted = [...places].sort((a, b) => a - b);
    for (let i = 1; i < sorted.length; i++) assert.ok(sorted[i] - sorted[i - 1] > 12 - 1e-9, `${wanted}: ${places}`);
    assert.ok(sorted[0] >= 0 && sorted.at(-1) <= 100 + 1e-9, `${wanted}: ${places}`);
  }
});

test("a zoom keeps a value in its place, and a range stays in the whole one", () => {
  assert.deepEqual(zoomed([0, 10], [0, 10], 4, 0.5), [2, 7]);
  assert.equal(zoomed([2, 7], [0, 10], 4, 3), null);
  assert.deepEqual(zoomed([0, 5], [0, 10], 5, 1.5), [0, 7.5]);
  assert.deepEqual(zoomed([2, 3], [0, 10], 2.5, 1e-9, 0.5), [2.25, 2.75]);
  assert.deepEqual(moved([2, 7], [0, 10], 1), [3, 8]);
  assert.deepEqual(moved([2, 7], [0, 10], 9), [5, 10]);
  assert.deepEqual(moved([2, 7], [0, 10], -9), [0, 5]);
});

test("a range follows the moment that leaves it", () => {
  const [from, to] = followed([2, 4], [0, 10], 3.9, 4.1);
  assert.ok(from <= 4.1 && to > 4.1 && Math.abs(to - from - 2) < 1e-12);
  assert.deepEqual(followed([2, 4], [0, 10], 3, 3.5), [2, 4]);
  assert.deepEqual(followed([2, 4], [0, 10], 6, 7), [2, 4]);
});

test("the nearest time is found", () => {
  const times = [0, 1, 2, 4];
  assert.deepEqual([-1, 0.4, 0.6, 2.9, 3.1, 9].map((time) => nearest(times, time)), [0, 0, 1, 2, 3, 3]);
  assert.equal(nearest([], 1), undefined);
  assert.deepEqual([-1, 0, 0.5, 4, 5].map((least) => firstFrom(times, least)), [0, 0, 1, 3, 4]);
});

/** Returns the numbers of a body whose y is a function of time. */
const body = (times, y, vy = () => 0) => Float64Array.from(times.flatMap((t) => [t, 0, y(t), 0, 0, vy(t), 0, ...Array(8).fill(0)]));
const LOCATION = QUANTITIES.find(({ name }) => name === "Body: location");
const VELOCITY = QUANTITIES.find(({ name }) => name === "Body: velocity");

test("the difference of two runs is at the times that both have", () => {
  const runs = [body([0, 1, 2, 3], (t) => t * t), body([0, 0.5, 1, 2], (t) => t)];
  const [, y] = curvesOf(LOCATION, against(LOCATION)[0], runs, true);
  assert.deepEqual([Array.from(y.times), Array.from(y.ys), y.name], [[0, 1, 2], [0, 0, 2], "y"]);
});

test("a phase plot has the velocity over the location", () => {
  const choice = against(VELOCITY).find(({ name }) => name === "y – vy");
  const [curve] = curvesOf(VELOCITY, choice, [body([0, 1, 2], Math.sin, Math.cos)]);
  assert.deepEqual([Array.from(curve.xs), Array.from(curve.ys)], [[0, 1, 2].map(Math.sin), [0, 1, 2].map(Math.cos)]);
});

test("a table has the shortest numbers that read back the same", () => {
  const values = Float64Array.from([0.1 + 0.2, -1e-300, NaN, 1e21]);
  const times = Float64Array.from([0, 1, 2, 3]);
  const table = tableOf("t (s)", [{ heading: "a (m)", times, values }, { heading: 'rk4, 1 s: "b"', times: times.slice(1), values: values.slice(1) }]);
  assert.equal(table, 't (s),a (m),"rk4, 1 s: ""b"""\n0,0.30000000000000004,\n1,-1e-300,-1e-300\n2,,\n3,1e+21,1e+21\n');
  const numbers = table.split("\n").slice(1, 5).map((row) => Number(row.split(",")[1] || NaN));
  assert.deepEqual(numbers, Array.from(values));
});

/** Returns a plot of random curves. */
function plotOf(next, times) {
  const wide = 10 ** (16 * next() - 8);
  const offset = next() < 0.3 ? wide * 10 ** (10 * next()) : 0;
  const words = ["kinetic", "potential", "total", "x"].slice(Math.floor(4 * next()));
  const xs = Float64Array.from(times);
  const curves = words.map((name) => ({ name, ink: "--ink", which: 0, times: xs, xs, ys: xs.map(() => offset + wide * (next() - 0.5)) }));
  const isOverTime = next() < 0.7;
  const whole = isOverTime ? [times[0], times.at(-1)] : undefined;
  const range = isOverTime && next() < 0.5 ? [times[0] + 0.3 * next() * (whole[1] - whole[0]), times.at(-1)] : undefined;
  return {
    curves, whole, window: { x: range }, equal: !isOverTime, styles: next() < 0.5 ? ["velocity-verlet", "explicit-euler"] : [],
    across: { label: "t", unit: "s" }, up: { label: "ball[0]: angular velocity", brief: "angular velocity", unit: "rad/s" },
  };
}

test("texts of plots are never cut and never over each other", () => {
  const next = random(3);
  for (let k = 0; k < 3000; k++) {
    const [width, height] = [Math.round(200 + 1200 * next()), Math.round(100 + 500 * next())];
    // Small plots have small letters.
    const size = width > 500 && height > 190 && next() < 0.5 ? 15 : 11;
    const duration = 10 ** (8 * next() - 4);
    const plot = plotOf(next, Array.from({ length: 30 }, (_, i) => (duration * i) / 29));
    const { marks, area } = layout(plot, { width, height, size, measure: (text) => 0.56 * size * text.length });
    const boxes = marks.filter(({ kind }) => kind === "text");
    for (const { text, box: [left, top, right, bottom] } of boxes) {
      assert.ok(left >= 0 && right <= width && top >= 0 && bottom <= height, `${text} is cut: ${width} × ${height}`);
    }
    for (const [i, { text, box: a }] of boxes.entries()) {
      for (const { text: other, box: b } of boxes.slice(0, i)) {
        assert.ok(a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] + 0.2 || b[3] <= a[1] + 0.2, `${text} and ${other} cover each other: ${width} × ${height}`);
      }
    }
    assert.ok(area.width > 100 && area.height > 40, `${width} × ${height}: ${JSON.stringify(area)}`);
    const across = boxes.filter(({ box, align }) => align === "center" && box[1] > area.top + area.height);
    const up = boxes.filter(({ box, align }) => align === "right" && box[2] < area.left);
    assert.ok(across.length >= (width < 300 ? 1 : 2) && up.length >= 2, `${width} × ${height}: ${across.map(({ text }) => text)}; ${up.map(({ text }) => text)}`);
  }
});

test("a curve is interrupted while its body is absent", () => {
  const xs = Float64Array.from([0, 1, 2, 3, 4, 5, 6]);
  const curve = { name: "y", ink: "--kinetic", which: 0, times: xs, xs, ys: Float64Array.from([1, 2, NaN, 3, NaN, 1, 2]) };
  const plot = { curves: [curve], whole: [0, 6], window: {}, styles: [], across: { label: "t", unit: "s" }, up: { label: "location", unit: "m" } };
  const { marks } = layout(plot, { width: 700, height: 300, size: 11, measure: (text) => 6 * text.length });
  const own = marks.filter(({ kind, ink }) => kind !== "text" && ink === "--kinetic");
  assert.deepEqual(own.map(({ kind, points }) => [kind, points?.length]), [["line", 4], ["dot", undefined], ["line", 4]]);
});

test("a run that breaks down is plotted as far as it has numbers", () => {
  for (const values of [[1, 1e200, 1e305, Infinity], [0, 5e-324, -5e-324, 0], [NaN, NaN, NaN, NaN], [-Infinity, 1, 2, Infinity]]) {
    const xs = Float64Array.from([0, 1, 2, 3]);
    const curve = { name: "y", ink: "--kinetic", which: 0, times: xs, xs, ys: Float64Array.from(values) };
    const plot = { curves: [curve], whole: [0, 3], window: {}, styles: [], across: { label: "t", unit: "s" }, up: { label: "energy", unit: "J" } };
    const { y, marks } = layout(plot, { width: 700, height: 300, size: 11, measure: (text) => 6 * text.length });
    assert.ok(y[1] > y[0] && y.every(Number.isFinite), `${values}: ${y}`);
    const places = marks.flatMap(({ points, x = 0, y = 0 }) => points ?? [x, y]);
    assert.ok(places.every(Number.isFinite), `${values}`);
  }
});

test("a drawing has escaped texts and no other marks than the plot", () => {
  const plot = { ...plotOf(random(4), [0, 1, 2]), up: { label: `<b>"&'`, unit: "m" } };
  const composed = layout(plot, { width: 700, height: 400, size: 14, measure: (text) => 8 * text.length });
  const drawing = asSvg(composed, () => "#123456");
  assert.ok(drawing.includes("&lt;b&gt;&quot;&amp;&apos; (m)"));
  const count = (tag) => drawing.split(`<${tag} `).length - 1;
  const marks = (kind) => composed.marks.filter((mark) => mark.kind === kind).length;
  assert.deepEqual(["text", "polyline", "circle"].map(count), ["text", "line", "dot"].map(marks));
});
