// The marks over a plot that change with time and with the pointer.

import { line } from "./layout.js";

/**
 * Returns the marks over a plot: the present moment, and the values at another one. `now` and `there` are places of values: `x` across, and the dots
 * of the curves. `there.rows` are texts in columns, each row with the color of its curve.
 */
export function overlay({ area, toX, toY, size, width }, plot, now, there, measure) {
  const marks = [];
  const bottom = area.top + area.height;
  const isIn = (x) => x >= area.left - 1 && x <= area.left + area.width + 1;
  const dots = (points, r) => points.forEach(({ x, y, ink }) => {
    if (isIn(toX(x)) && !Number.isNaN(y)) marks.push({ kind: "dot", x: toX(x), y: toY(y), r, ink, ring: true, clip: true });
  });
  const upright = (x, ink, wide) => isIn(toX(x)) && marks.push(line([toX(x), area.top, toX(x), bottom], ink, wide));
  if (now) {
    if (plot.whole) upright(now.x, "--accent", 0.13 * size);
    dots(plot.whole ? [] : now.points, 0.4 * size);
  }
  if (!there) return marks;
  upright(there.x, "--quiet", 1);
  if (!plot.whole) there.points.forEach(({ y }) => marks.push(line([area.left, toY(y), area.left + area.width, toY(y)], "--quiet", 1, { clip: true })));
  dots(there.points, 0.27 * size);
  // The values stand beside the line, on the side that has room for them.
  const columns = there.rows[0].cells.map((_, k) => Math.max(...there.rows.map(({ cells }) => measure(cells[k] ?? ""))) + (k ? 0.8 * size : 0));
  const [wide, high] = [columns.reduce((sum, column) => sum + column, 0) + 1.1 * size, (1.25 * there.rows.length + 0.5) * size];
  const place = toX(there.x);
  const left = place + 0.8 * size + wide <= width ? place + 0.8 * size : Math.max(0, place - 0.8 * size - wide);
  const top = Math.max(0, Math.min(area.top + 0.3 * size, bottom + 1.5 * size - high));
  marks.push({ kind: "box", x: left, y: top, width: wide, height: high });
  there.rows.forEach(({ cells, ink }, row) => {
    let x = left + 0.55 * size;
    cells.forEach((text, k) => {
      x += columns[k];
      const y = top + (1.25 * row + 0.9) * size;
      if (text) marks.push(k ? { kind: "text", text, x, y, align: "right", ink: "--ink" } : { kind: "text", text, x: left + 0.55 * size, y, align: "left", ink: ink ?? "--quiet" });
    });
  });
  return marks;
}
