// Labels, numbers and plots over the picture. They are set as plain text, so that texts of a scene are never interpreted as HTML.

import { AXES } from "./lines.js";
import { add, css, projected, sub, times, turned } from "../math.js";
import { plotShapes, scenePlots } from "./scene_plots.js";

/** The largest number of triads of axes with letters. More letters would hide the picture. */
const MOST_TRIADS = 20;

/**
 * Returns what stands over the picture of a frame: the plots (`plots`), and the texts (`texts`) with the letters at triads of axes and the scale
 * bar. `at(body)` returns the location of a body. `fonts` are the fonts that labels have of their own.
 */
export function layout(shown, view, space, at, triads, plots, fonts) {
  const [left, top, width, height] = view.rectangle;
  const { seenWidth } = view;
  const texts = [];
  // The coordinates of texts go from -1 to 1 across the picture of the scene's camera.
  const place = (x, y) => [left + ((x + 1) / 2) * width, top + height / 2 - (y / 2) * width];
  // With the scene's camera, labels are also shown beside ghosts. With any other camera, only the label of the present moment is shown.
  const latest = new Set(new Map((shown?.texts ?? []).map((text) => [text.beside ? text.name : text, text])).values());
  for (const text of shown?.texts ?? []) {
    let [x, y] = place(text.x, text.y);
    if (view.own && (text.in_world || !latest.has(text))) continue;
    if (view.own && text.beside) [x, y] = beside(text, view, space, at, seenWidth);
    if (view.own && text.anchor) [x, y] = anchored(text, view, space, seenWidth);
    if (x === undefined) continue;
    const family = fonts[text.font] && `"${fonts[text.font].family}", ${USUAL_FAMILY}`;
    texts.push(placed(text, x, y, (text.height / 2) * seenWidth, { halo: haloOf(text.color), family }));
  }
  if (triads.length <= MOST_TRIADS) texts.push(...triads.flatMap((triad) => letters(triad, view, space)));
  if (shown?.bar && !view.own) {
    const { from, to, y, thickness, color } = shown.bar;
    texts.push({ bar: [...place(from, y), ((to - from) / 2) * width, Math.max(2, (thickness / 2) * width)], color: css(color) });
  }
  for (const text of plots.flatMap((plot) => plot.texts)) texts.push(placed(text, ...place(text.x, text.y), (text.height / 2) * width));
  return { plots: plotShapes(plots, shown?.plots, place, width), texts };
}

/** The fonts of texts that have none of their own. */
export const USUAL_FAMILY = '"DejaVu Sans", sans-serif';

/** Returns the color of the outline of letters. */
const haloOf = (color) => (color[0] + color[1] + color[2] > 1.5 ? "#111" : "#fff");

/** Returns a text at a point of the picture: the height of its letters (`size`), and that of a line, relative to it. */
function placed({ says, line, align, color }, x, y, height, more = {}) {
  return { says, line: line ?? 1, align, color: css(color), x, y, size: Math.max(9, height), ...more };
}

/** Returns the letters x, y and z at the ends of a triad. */
function letters({ location, orientation, length: arm }, view, space) {
  return AXES.flatMap((color, axis) => {
    const end = add(location, turned(orientation, [0, 1, 2].map((k) => (k === axis ? 1.14 * arm : 0))));
    const spot = projected(view.clip, times(sub(end, space.center), 1 / space.size));
    const size = (0.25 * arm * view.focal) / space.size / spot.w;
    if (!(spot.w > 0) || size < 7) return [];
    const [x, y] = [((spot.x + 1) / 2) * view.width, ((1 - spot.y) / 2) * view.height];
    return [placed({ says: [["xyz"[axis], 1, 0, false]], align: 0.5, color }, x, y + 0.35 * size, size, { axis: true })];
  });
}

export class Texts {
  constructor(element) {
    this.element = element;
  }

  /** Shows what stands over the picture. */
  show({ plots, texts }) {
    const charts = plots.length ? [scenePlots(plots)] : [];
    this.element.replaceChildren(...charts, ...texts.map((text) => (text.bar ? bar(text) : span(text))));
  }
}

function span({ says, x, y, size, line, align, color, halo, family, axis }) {
  const made = document.createElement("span");
  made.append(...says.map(([letters, part, rise, bold]) => set(letters, part, rise, bold, size)));
  made.style.fontSize = `${size}px`;
  made.style.lineHeight = line;
  made.style.textAlign = ["left", "center", "right"][2 * align];
  made.style.color = color;
  made.style.textShadow = halo ? [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([a, b]) => `${a}px ${b}px 1px ${halo}`).join(",") : "none";
  made.style.transform = `translate(${x}px, ${y}px) translate(${-100 * align}%, ${-(0.35 + line / 2) * size}px)`;
  if (family) made.style.fontFamily = family;
  if (axis) made.className = "axis";
  return made;
}

function bar({ bar: [x, y, width, height], color }) {
  const made = document.createElement("span");
  made.style.width = `${width}px`;
  made.style.height = `${height}px`;
  made.style.background = color;
  made.style.transform = `translate(${x}px, ${y}px)`;
  return made;
}

/** Returns the position of a text at a point of the world, for a camera other than the scene's. */
function anchored({ anchor: [point, [right, up]] }, view, space, width) {
  const spot = projected(view.clip, times(sub(point, space.center), 1 / space.size));
  if (!(spot.w > 0)) return [];
  return [((spot.x + 1) / 2) * view.width + (right / 2) * width, ((1 - spot.y) / 2) * view.height - (up / 2) * width];
}

/** Returns letters of a text: a text node, or an element with bold letters or smaller ones that stand `rise` times `size` above the line. */
function set(letters, part, rise, bold, size) {
  if (part === 1 && !bold) return letters;
  const element = document.createElement(part === 1 ? "b" : "small");
  element.textContent = letters;
  if (bold) element.style.fontWeight = "bold";
  if (part === 1) return element;
  element.style.fontSize = `${part * size}px`;
  element.style.bottom = `${rise * size}px`;
  return element;
}

/** Returns the position of a label beside its body, for a camera other than the scene's. */
function beside(text, view, space, at, width) {
  const [body, side] = text.beside;
  const location = at(body);
  if (!location) return [];
  const spot = projected(view.clip, times(sub(location, space.center), 1 / space.size));
  if (!(spot.w > 0)) return [];
  const away = { above: [0, -1.2], below: [0, 1.6], left: [-1, 0.4], right: [1, 0.4] }[side];
  const size = (text.height / 2) * width;
  const [x, y] = add([((spot.x + 1) / 2) * view.width, ((1 - spot.y) / 2) * view.height, 0], times([...away, 0], size));
  return [x, y];
}
