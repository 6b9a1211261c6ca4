// The plots of the scene, over the picture: panels with curves, as scripts draw them. Their letters are set by texts.js.

import { css } from "../math.js";

const SVG = "http://www.w3.org/2000/svg";

function element(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

/**
 * Returns what is drawn of each plot in a picture `width` pixels wide: its name, and its shapes in order. Each shape is an element of SVG: its name
 * and its attributes. The points of a curve are a list, and a strip is filled with `colors`, from left to right. `now` has, for each plot, its
 * bars, and for each curve the number of points to draw and its place.
 */
export function plotShapes(plots, now, place, width) {
  // The coordinates of the image plane go from -1 to 1 across the picture.
  const pixels = (length) => (length / 2) * width;
  return plots.map((plot, number) => {
    const [left, bottom] = place(plot.left, plot.bottom);
    const at = ([x, y]) => [left + pixels(x), bottom - pixels(y)];
    const [wide, high] = plot.size.map(pixels);
    const shapes = [["rect", { x: left, y: bottom - high, width: wide, height: high, fill: css(plot.paper), "fill-opacity": 0.9 }]];
    const box = ({ from, to, ...more }) => {
      const [[x, below], [right, y]] = [at(from), at(to)];
      shapes.push(["rect", { ...more, x, y, width: right - x, height: below - y }]);
    };
    if (plot.strip) box({ from: plot.strip.from, to: plot.strip.to, colors: plot.strip.colors.map(css) });
    const rule = ({ from, to, color }) => {
      const [[x1, y1], [x2, y2]] = [at(from), at(to)];
      shapes.push(["line", { x1, y1, x2, y2, stroke: css(color), "stroke-width": Math.max(0.9, pixels(0.0015)) }]);
    };
    plot.lines.filter((line) => !line.is_axis).forEach(rule);
    for (const { from, to, color } of now?.[number]?.bars ?? []) box({ from, to, class: "bar", fill: css(color) });
    plot.lines.filter((line) => line.is_axis).forEach(rule);
    const stroke = Math.max(1.5, pixels(0.0064));
    plot.curves.forEach((curve, k) => {
      const { count, here } = now?.[number]?.curves[k] ?? { count: 0, here: null };
      const draw = (points, color) => {
        for (const part of parts(points)) {
          shapes.push(["polyline", { points: part.map(at), fill: "none", stroke: css(color), "stroke-width": stroke, "stroke-linejoin": "round", "stroke-linecap": "round" }]);
        }
      };
      if (curve.pale) draw(curve.points, curve.pale);
      const past = curve.points.slice(0, count);
      if (here && past.at(-1)) past.push(here);
      draw(past, curve.color);
      if (here) {
        const [cx, cy] = at(here);
        shapes.push(["circle", { cx, cy, r: Math.max(2, pixels(plot.dot)), fill: css(curve.color) }]);
      }
    });
    return { name: plot.name, shapes };
  });
}

/** Returns an SVG with the shapes of all plots. */
export function scenePlots(plots) {
  const svg = element("svg", { class: "plots" });
  plots.forEach(({ name, shapes }, number) => {
    const group = element("g", { "data-plot": name });
    for (const [kind, { points, colors, ...attributes }] of shapes) {
      if (points) attributes.points = points.map((point) => point.join()).join(" ");
      if (colors) {
        const id = `colors-${number}`;
        group.append(gradient(colors, id));
        attributes.fill = `url(#${id})`;
      }
      group.append(element(kind, attributes));
    }
    svg.append(group);
  });
  return svg;
}

/** Returns a gradient through some colors, from left to right. */
function gradient(colors, id) {
  const made = element("linearGradient", { id });
  colors.forEach((color, k) => made.append(element("stop", { offset: k / (colors.length - 1), "stop-color": color })));
  return made;
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
