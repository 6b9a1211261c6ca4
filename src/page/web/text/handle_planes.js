// The planes in which handles are moved: those of two axes of the world, so that the third number stays as it is.

const PLANES = [[0, 1], [0, 2], [1, 2]];
const GROUND = 1;
/** A way above this many sizes of the scene is one toward the horizon. */
const MOST_WAY = 100;
/** The largest change of a number for a pixel, as a part of the step to which numbers are rounded. */
const PIXELS_OF_STEP = 2.5;

/**
 * The transform of a point that moves along two axes. The picture shows it at the coordinates X, Y from -1 to 1 where x = X w and y = Y w: two
 * linear equations for the ways along the axes, m. Returns both, as [coefficient, coefficient, right side], and w as a function of the ways.
 */
function equations({ clip }, { center, size }, from, axes, [X, Y]) {
  const p = from.map((number, i) => (number - center[i]) / size);
  const base = (row) => clip[row] * p[0] + clip[4 + row] * p[1] + clip[8 + row] * p[2] + clip[12 + row];
  const along = (row) => axes.map((axis) => clip[4 * axis + row] / size);
  const [w, wAlong] = [base(3), along(3)];
  const line = (row, at) => [...along(row).map((number, i) => number - at * wAlong[i]), at * w - base(row)];
  return { x: line(0, X), y: line(1, Y), w: (ways) => w + wAlong[0] * ways[0] + wAlong[1] * ways[1] };
}

const fromPixel = ({ width, height }, [x, y]) => [(2 * x) / width - 1, 1 - (2 * y) / height];

/**
 * Returns how far a point moves along two axes of the world until the picture shows it at a pixel, m. Undefined if the plane of the axes does not
 * reach there.
 */
export function onPlane(view, space, from, axes, pixel) {
  const { x: [a, b, e], y: [c, d, f], w } = equations(view, space, from, axes, fromPixel(view, pixel));
  const det = a * d - b * c;
  const ways = [(e * d - b * f) / det, (a * f - e * c) / det];
  const isNear = ways.every((way) => Math.abs(way) <= MOST_WAY * space.size);
  return isNear && w(ways) > 0 ? ways : undefined;
}

/**
 * Returns two planes through a point: the one that faces the viewer most, and another, of the ground if possible. Each has its axes (`axes`), the
 * step of round numbers for a scale of the numbers (`step`), and the axis and the sign that lead in a direction of the picture (`along`).
 */
export function planesOf(view, space, from) {
  const { clip, width, height } = view;
  const p = from.map((number, i) => (number - space.center[i]) / space.size);
  const row = (k) => clip[k] * p[0] + clip[4 + k] * p[1] + clip[8 + k] * p[2] + clip[12 + k];
  const [X, Y] = [row(0) / row(3), row(1) / row(3)];
  const planes = PLANES.map((axes) => {
    const { x, y } = equations(view, space, from, axes, [X, Y]);
    // How far the picture of the point moves for a meter along each axis, px.
    const moves = [0, 1].map((i) => [(x[i] / row(3)) * (width / 2), (-y[i] / row(3)) * (height / 2)]);
    const area = Math.abs(moves[0][0] * moves[1][1] - moves[0][1] * moves[1][0]);
    return {
      axes, area,
      step: (scale) => 10 ** Math.floor(Math.log10((PIXELS_OF_STEP * scale) / Math.sqrt(area))),
      along: (direction) => {
        const toward = moves.map((move) => (move[0] * direction[0] + move[1] * direction[1]) / Math.hypot(...move));
        const i = Math.abs(toward[1]) > Math.abs(toward[0]) ? 1 : 0;
        return { axis: axes[i], sign: Math.sign(toward[i]) };
      },
    };
  });
  const [best, second] = [...planes].sort((one, two) => two.area - one.area);
  return [best, best === planes[GROUND] ? second : planes[GROUND]];
}
