// Labels, numbers and plots over the picture. They are set as plain text, so that texts of a scene are never interpreted as HTML.

import { AXES } from "./lines.js";
import { add, css, projected, sub, times, turned } from "./math.js";
import { scenePlots } from "./scene_plots.js";

/** The largest number of triads of axes with letters. More letters would hide the picture. */
const MOST_TRIADS = 20;

export class Texts {
  constructor(element) {
    this.element = element;
  }

  /**
   * Shows the plots and the texts of a frame, and the letters at triads of axes. `at(body)` returns the location of a body. `fonts` are the
   * fonts that labels have of their own.
   */
  show(shown, view, space, at, triads, plots, fonts) {
    const [left, top, width, height] = view.rectangle;
    const spans = [];
    // The coordinates of texts go from -1 to 1 across the picture of the scene's camera.
    const place = (x, y) => [left + ((x + 1) / 2) * width, top + height / 2 - (y / 2) * width];
    // With the scene's camera, labels are also shown beside ghosts. With any other camera, only the label of the present moment is shown.
    const latest = new Set(new Map((shown?.texts ?? []).map((text) => [text.beside ? text.name : text, text])).values());
    for (const text of shown?.texts ?? []) {
      let [x, y] = place(text.x, text.y);
      if (view.own && (text.in_world || !latest.has(text))) continue;
      if (view.own && text.beside) [x, y] = beside(text, view, space, at, width);
      if (view.own && text.anchor) [x, y] = anchored(text, view, space, width);
      if (x === undefined) continue;
      const span = this.span(text, x, y, (text.height / 2) * width);
      if (fonts[text.font]) span.style.fontFamily = `"${fonts[text.font].family}", "DejaVu Sans", sans-serif`;
      spans.push(span);
    }
    if (triads.length <= MOST_TRIADS) spans.push(...triads.flatMap((triad) => this.letters(triad, view, space)));
    if (shown?.bar && !view.own) spans.push(this.bar(shown.bar, place, width));
    const charts = plots.length ? [scenePlots(plots, shown?.plots, place, width)] : [];
    for (const text of plots.flatMap((plot) => plot.texts)) {
      const span = this.span(text, ...place(text.x, text.y), (text.height / 2) * width);
      span.style.textShadow = "none";
      spans.push(span);
    }
    this.element.replaceChildren(...charts, ...spans);
  }

  span(text, x, y, height) {
    const span = document.createElement("span");
    const size = Math.max(9, height);
    span.append(...text.says.map(([letters, part, rise, bold]) => set(letters, part, rise, bold, size)));
    const halo = text.color[0] + text.color[1] + text.color[2] > 1.5 ? "#111" : "#fff";
    span.style.fontSize = `${size}px`;
    span.style.lineHeight = text.line ?? 1;
    span.style.textAlign = ["left", "center", "right"][2 * text.align];
    span.style.color = css(text.color);
    span.style.textShadow = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([a, b]) => `${a}px ${b}px 1px ${halo}`).join(",");
    span.style.transform = `translate(${x}px, ${y}px) translate(${-100 * text.align}%, ${-(0.35 + (text.line ?? 1) / 2) * size}px)`;
    return span;
  }

  /** Returns the letters x, y and z at the ends of a triad. */
  letters({ location, orientation, length: arm }, view, space) {
    return AXES.flatMap((color, axis) => {
      const end = add(location, turned(orientation, [0, 1, 2].map((k) => (k === axis ? 1.14 * arm : 0))));
      const spot = projected(view.clip, times(sub(end, space.center), 1 / space.size));
      const size = (0.25 * arm * view.focal) / space.size / spot.w;
      if (!(spot.w > 0) || size < 7) return [];
      const [x, y] = [((spot.x + 1) / 2) * view.width, ((1 - spot.y) / 2) * view.height];
      const span = this.span({ says: [["xyz"[axis], 1, 0, false]], height: 0, align: 0.5, color }, x, y + 0.35 * size, size);
      span.className = "axis";
      span.style.textShadow = "none";
      return [span];
    });
  }

  bar(bar, place, width) {
    const span = document.createElement("span");
    const [x, y] = place(bar.from, bar.y);
    span.style.width = `${((bar.to - bar.from) / 2) * width}px`;
    span.style.height = `${Math.max(2, (bar.thickness / 2) * width)}px`;
    span.style.background = css(bar.color);
    span.style.transform = `translate(${x}px, ${y}px)`;
    return span;
  }
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
