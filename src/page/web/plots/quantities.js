// The quantities that can be plotted, and their curves.

const INK = { first: "--kinetic", second: "--potential", third: "--total" };
const TIME = { name: "over time", across: { name: "t", unit: "s", at: 0 } };

/**
 * The quantities. Their values come from the 13 numbers of a frame's balance, or from the 15 numbers of a body. Each curve has a name, a color,
 * and a function that returns its value in the frame whose numbers begin at an index.
 */
export const QUANTITIES = [
  { name: "Energy", unit: "J", of: "balance", curves: [one("kinetic", INK.first, 1), one("potential", INK.second, 2), one("total", INK.third, 3)] },
  { name: "Drift", unit: "J", of: "balance", curves: [["total − work", INK.third, (n, i) => n[i + 3] - n[i + 4]]] },
  { name: "Momentum", unit: "kg m/s", of: "balance", curves: vector(6) },
  { name: "Angular momentum", unit: "kg m²/s", of: "balance", curves: vector(9) },
  { name: "Impacts", unit: "", of: "balance", counts: true, curves: [one("impacts", INK.first, 12)] },
  { name: "Body: location", unit: "m", of: "body", curves: vector(1), against: [path("x", "y"), path("x", "z"), path("z", "y")] },
  { name: "Body: velocity", unit: "m/s", of: "body", curves: vector(4), against: ["x", "y", "z"].map(phase) },
  { name: "Body: angular velocity", unit: "rad/s", of: "body", curves: vector(7) },
  { name: "Body: force", unit: "N", of: "body", curves: vector(10) },
  { name: "Body: kinetic energy", unit: "J", of: "body", curves: [one("kinetic", INK.first, 13)] },
  { name: "Body: impacts", unit: "", of: "body", counts: true, curves: [one("impacts", INK.first, 14)] },
];

function one(name, ink, at) {
  return [name, ink, (n, i) => n[i + at]];
}

function vector(at) {
  return ["x", "y", "z"].map((axis, k) => one(axis, Object.values(INK)[k], at + k));
}

/** The path of a body, seen along an axis. Lengths are the same across and up. */
function path(across, up) {
  const at = (axis) => 1 + "xyz".indexOf(axis);
  return { name: `${across} – ${up}`, equal: true, across: { name: across, unit: "m", at: at(across) }, up: { name: up, unit: "m", at: at(up) } };
}

/** A component of the velocity against the same component of the location. */
function phase(axis, k) {
  return { name: `${axis} – v${axis}`, across: { name: axis, unit: "m", at: 1 + k }, up: { name: `v${axis}`, unit: "m/s", at: 4 + k } };
}

/** Returns what a quantity can be plotted against: the time, and what else there is. */
export const against = (quantity) => [TIME, ...(quantity.against ?? [])];

/** The count of numbers of a frame. */
const stride = (quantity) => (quantity.of === "balance" ? 13 : 15);

/**
 * Returns the curves of a quantity in one run or in two: name, color, number of the run (`which`), and for each frame the time, the place across
 * and the place up. `difference`: the curves are those of the first run minus those of the second, at the times that both have.
 */
export function curvesOf(quantity, choice, runs, difference = false) {
  const known = runs.map((numbers) => numbers ?? new Float64Array());
  const named = choice.up ? [[choice.up.name, INK.first, (n, i) => n[i + choice.up.at]]] : quantity.curves;
  const of = (numbers, which) => {
    const times = column(numbers, stride(quantity), (n, i) => n[i]);
    const xs = choice.up ? column(numbers, stride(quantity), (n, i) => n[i + choice.across.at]) : times;
    return named.map(([name, ink, value]) => ({ name, ink, which, times, xs, ys: column(numbers, stride(quantity), value) }));
  };
  const [first, second] = known.map(of);
  if (!difference || !second) return [...(first ?? []), ...(second ?? [])];
  return first.map((curve, k) => between(curve, second[k]));
}

function column(numbers, stride, value) {
  return Float64Array.from({ length: Math.floor(numbers.length / stride) }, (_, frame) => value(numbers, frame * stride));
}

/** Returns the difference of two curves over the time. */
function between(a, b) {
  const [times, ys] = [[], []];
  for (let i = 0, k = 0; i < a.times.length && k < b.times.length; ) {
    const apart = a.times[i] - b.times[k];
    if (Math.abs(apart) <= 1e-9 * Math.abs(a.times[i])) {
      times.push(a.times[i]);
      ys.push(a.ys[i++] - b.ys[k++]);
    } else if (apart < 0) i++;
    else k++;
  }
  const shared = Float64Array.from(times);
  return { ...a, times: shared, xs: shared, ys: Float64Array.from(ys) };
}

/** Returns the index of the time that is nearest to `time`. Undefined without times. */
export function nearest(times, time) {
  if (!times.length) return undefined;
  const after = Math.min(times.length - 1, firstFrom(times, time));
  return after > 0 && time - times[after - 1] < times[after] - time ? after - 1 : after;
}

/** Returns the index of the first of some rising numbers that is at least `least`. */
export function firstFrom(numbers, least) {
  let [before, after] = [-1, numbers.length];
  while (after - before > 1) {
    const middle = (before + after) >> 1;
    if (numbers[middle] < least) before = middle;
    else after = middle;
  }
  return after;
}
