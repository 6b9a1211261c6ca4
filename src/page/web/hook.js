// `window.jabuka`: an interface for programs, such as tests, that control the page or read what it shows.

import { drawn, element, open, panel, player, plots, redraw } from "./parts.js";
import { diagnostics } from "./text/scene_text.js";

window.jabuka = {
  get frame() { return player.frame; },
  get frames() { return open.run?.frames ?? 0; },
  get time() { return player.time; },
  get playing() { return player.playing; },
  get name() { return open.run?.description.name ?? null; },
  get run() { return open.run?.id ?? null; },
  get integrator() { return open.run?.description.integrator ?? null; },
  get recorded() { return open.run?.progress?.recorded ?? 0; },
  get settled() { return Boolean(open.run?.description.settled); },
  get problem() { return element("problem").hidden || element("problem").classList.contains("mild") ? null : element("problem").textContent; },
  get diagnostics() { return diagnostics(); },
  get comparison() { return element("comparison").textContent; },
  get selected() { return open.run?.description.bodies[panel.body]?.name ?? null; },
  get drawn() { return { count: drawn.count, run: drawn.run, frame: drawn.frame }; },
  /** The plot: the area of its curves in pixels of its canvas, the shown ranges across and up, its texts with their boxes, and its curves. */
  get plot() {
    const { area, x, y, size, marks, curves } = plots.composed ?? { marks: [], curves: [] };
    const texts = marks.filter(({ kind }) => kind === "text").map(({ text, box }) => ({ text, box }));
    return { area, x, y, size, texts, curves: curves.map(({ name, which, times, xs, ys }) => ({ name, which, times: Array.from(times), xs: Array.from(xs), ys: Array.from(ys) })) };
  },
  /** The transform from world coordinates (m) to the picture: (point - center) / size, and then the matrix `clip`. */
  get view() {
    const { clip, width, height } = drawn.view ?? { clip: [] };
    return { clip: Array.from(clip), width, height, ...open.painter.space };
  },
  get bodies() { return open.run?.description.bodies.map(({ name }) => name) ?? []; },
  /** Returns the pose of a body (by name or index) in a frame: location (m) and orientation (x y z w). Null until it is fetched. */
  pose(body, frame = player.frame) {
    const number = typeof body === "number" ? body : (panel.numbers?.get(body) ?? -1);
    return open.run?.pose(number, frame) ?? null;
  },
  seek(frame) { player.pause(); player.seek(frame); redraw(); },
  play() { player.play(); redraw(); },
  pause() { player.pause(); redraw(); },
  reset() { player.reset(); redraw(); },
  /** Returns a promise that resolves when the requested frame has been drawn, or when the condition `is` holds. */
  whenDrawn(is = () => drawn.run === open.run?.id && drawn.frame === player.frame && !drawn.dirty) {
    return new Promise((resolve) => {
      drawn.waiting.push(() => (is(window.jabuka) ? (resolve(window.jabuka.drawn), true) : false));
      redraw();
    });
  },
};
