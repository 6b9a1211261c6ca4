// The part of an axis that a plot shows: a range of values, `[from, to]`.

/** The greatest enlargement of an axis. */
const MOST = 1e6;

/**
 * Returns a range that is `factor` times as long, in which the value `fixed` keeps its place. A range stays within the whole one. Returns
 * `null` if all of it is shown.
 */
export function zoomed([from, to], whole, fixed, factor, least = (whole[1] - whole[0]) / MOST) {
  const length = Math.max(least, (to - from) * factor);
  if (length >= (whole[1] - whole[0]) * (1 - 1e-9)) return null;
  const start = fixed - ((fixed - from) / (to - from)) * length;
  return within([start, start + length], whole);
}

/** Returns a range that begins `by` later, but within the whole one. */
export function moved([from, to], whole, by) {
  return within([from + by, to + by], whole);
}

function within([from, to], [first, last]) {
  const length = to - from;
  const start = Math.max(first, Math.min(last - length, from));
  return [start, start + length];
}

/** Returns a range of the same length in which a value is that was in the range before. */
export function followed(range, whole, before, now) {
  const isIn = (value) => value >= range[0] && value <= range[1];
  if (isIn(now) || !isIn(before)) return range;
  const length = range[1] - range[0];
  return within(now > range[1] ? [now - 0.1 * length, now + 0.9 * length] : [now - 0.9 * length, now + 0.1 * length], whole);
}
