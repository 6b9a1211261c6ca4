// The plots of the scene, over the picture: panels with curves, as scripts draw them. Their letters are set by texts.js.

import { css } from "./math.js";

const SVG = "http://www.w3.org/2000/svg";

function shape(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

/**
 * Returns an SVG with all plots in a picture `width` pixels wide. `now` has, for each plot, its bars, and for each curve the number of points to
 * draw and its place.
 */
export function scenePlots(plots, now, place, width) {
  const svg = shape("svg", { class: "plots" });
  // The coordinates of the image plane go from -1 to 1 across the picture.
  const pixels = (length) => (length / 2) * width;
  plots.forEach((plot, number) => {
    const [left, bottom] = place(plot.left, plot.bottom);
    const at = ([x, y]) => [left + pixels(x), bottom - pixels(y)];
    const [wide, high] = plot.size.map(pixels);
    const group = shape("g", { "data-plot": plot.name });
    group.append(shape("rect", { x: left, y: bottom - high, width: wide, height: high, fill: css(plot.paper), "fill-opacity": 0.9 }));
    if (plot.strip) group.append(...strip(plot.strip, `colors-${number}`, at));
    const rule = ({ from, to, color }) => {
      const [[x1, y1], [x2, y2]] = [at(from), at(to)];
      group.append(shape("line", { x1, y1, x2, y2, stroke: css(color), "stroke-width": Math.max(0.9, pixels(0.0015)) }));
    };
    plot.lines.filter((line) => !line.is_axis).forEach(rule);
    for (const { from, to, color } of now?.[number]?.bars ?? []) {
      const [[x, bottom], [right, y]] = [at(from), at(to)];
      group.append(shape("rect", { class: "bar", x, y, width: right - x, height: bottom - y, fill: css(color) }));
    }
    plot.lines.filter((line) => line.is_axis).forEach(rule);
    const stroke = Math.max(1.5, pixels(0.0064));
    plot.curves.forEach((curve, k) => {
      const { count, here } = now?.[number]?.curves[k] ?? { count: 0, here: null };
      const draw = (points, color) => {
        for (const part of parts(points)) {
          const line = { points: part.map((point) => at(point).join()).join(" "), fill: "none", stroke: css(color), "stroke-width": stroke };
          group.append(shape("polyline", { ...line, "stroke-linejoin": "round", "stroke-linecap": "round" }));
        }
      };
      if (curve.pale) draw(curve.points, curve.pale);
      const past = curve.points.slice(0, count);
      if (here && past.at(-1)) past.push(here);
      draw(past, curve.color);
      if (here) {
        const [cx, cy] = at(here);
        group.append(shape("circle", { cx, cy, r: Math.max(2, pixels(plot.dot)), fill: css(curve.color) }));
      }
    });
    svg.append(group);
  });
  return svg;
}

/** Returns the strip of a color bar, and the gradient with this name that fills it. */
function strip({ from, to, colors }, id, at) {
  const [[x, below], [right, y]] = [at(from), at(to)];
  const gradient = shape("linearGradient", { id });
  colors.forEach((color, k) => gradient.append(shape("stop", { offset: k / (colors.length - 1), "stop-color": css(color) })));
  return [gradient, shape("rect", { x, y, width: right - x, height: below - y, fill: `url(#${id})` })];
}

/** Divides a curve at its gaps. */
function parts(points) {
  const all = [[]];
  for (const point of points) {
    if (point) all.at(-1).push(point);
    else all.push([]);
  }
  return all.filter((part) => part.length > 1);
}
