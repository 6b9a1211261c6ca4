// Round numbers at the axes of a plot, and places for the names of its curves.

/** The largest and the smallest size that is written without an exponent. */
const [LARGEST, SMALLEST] = [1e6, 1e-3];

/** Returns the order of magnitude of a positive number. The sum makes up for the rounding error of the logarithm. */
const order = (size) => Math.floor(Math.log10(size) + 1e-9);

/** Returns the smallest of the numbers …, 0.5, 1, 2, 5, 10, … that is at least `least`. */
export function roundStep(least) {
  const decade = 10 ** order(least);
  return ([1, 2, 5].find((part) => part * decade >= least * (1 - 1e-9)) ?? 10) * decade;
}

/**
 * Returns the round numbers between two values, with at most `most` steps from the first value to the last one: where they stand (`at`) and
 * how they are written (`text`). If they need more than `digits` digits, the texts are differences from `offset`. `whole`: no number lies between
 * two integers.
 */
export function ticks(low, high, most, { digits = 5, whole = false } = {}) {
  const least = (high - low) / Math.max(1, most);
  const step = whole ? Math.max(1, roundStep(least)) : roundStep(least);
  const size = Math.max(Math.abs(low), Math.abs(high));
  const offset = order(size) - order(step) + 1 > digits ? nearby((low + high) / 2, high - low) : 0;
  const first = Math.ceil((low - offset) / step - 1e-9);
  const last = Math.floor((high - offset) / step + 1e-9);
  const multiples = Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => Number(((first + k) * step).toPrecision(12)));
  const largest = Math.max(0, ...multiples.map(Math.abs));
  return { step, offset, ticks: multiples.map((multiple) => ({ at: offset + multiple, text: written(multiple, step, largest) })) };
}

/** Returns a number with few digits near `middle`. */
function nearby(middle, span) {
  const unit = roundStep(span);
  const digits = order(Math.abs(middle)) - order(unit) + 1;
  return digits < 1 ? 0 : Number((Math.round(middle / unit) * unit).toPrecision(Math.min(16, digits + 1)));
}

/** Writes a multiple of `step`. All numbers of an axis have as many digits behind the point, so that their points stand below each other. */
function written(multiple, step, largest) {
  if (largest < LARGEST && largest >= SMALLEST) return sign(multiple.toFixed(Math.max(0, -order(step))));
  if (multiple === 0) return "0";
  return sign(multiple.toExponential(Math.max(0, order(Math.abs(multiple)) - order(step))).replace(/\.?0+e/, "e").replace("e+", "e"));
}

const sign = (text) => text.replace(/-/g, "−");

/** Writes the offset of an axis behind its name: `energy − 12.5`. */
export function shifted(name, offset) {
  if (!offset) return name;
  const size = Math.abs(offset);
  const text = size < LARGEST && size >= SMALLEST ? String(size) : size.toExponential().replace("e+", "e");
  return `${name} ${offset > 0 ? "−" : "+"} ${sign(text)}`;
}

/**
 * Returns places for labels that are `size` high: as near to the wanted places as possible, in the same order, not over each other, and with
 * centers from `top` to `bottom`.
 */
export function spread(wanted, size, top, bottom) {
  const sorted = wanted.map((_, k) => k).sort((a, b) => wanted[a] - wanted[b]);
  // Labels that would cover each other form a group, whose center is the mean of the wanted ones.
  const groups = [];
  sorted.forEach((label, k) => {
    let group = { labels: [label], sum: wanted[label] - k * size };
    const mean = ({ sum, labels }) => sum / labels.length;
    while (groups.length && mean(groups.at(-1)) > mean(group)) {
      const before = groups.pop();
      group = { labels: [...before.labels, ...group.labels], sum: before.sum + group.sum };
    }
    groups.push(group);
  });
  const places = [];
  const lowest = bottom - (wanted.length - 1) * size;
  let k = 0;
  for (const { labels, sum } of groups) {
    for (const label of labels) places[label] = Math.max(top, Math.min(lowest, sum / labels.length)) + k++ * size;
  }
  return places;
}
