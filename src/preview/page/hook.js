// `window.jabuka`, for programs: what the page knows and does.

import { drawn, element, open, panel, player, redraw } from "./parts.js";

window.jabuka = {
  get frame() { return player.frame; },
  get frames() { return open.run?.frames ?? 0; },
  get time() { return player.time; },
  get playing() { return player.playing; },
  get run() { return open.run?.id ?? null; },
  get integrator() { return open.run?.description.integrator ?? null; },
  get recorded() { return open.run?.progress?.recorded ?? 0; },
  get settled() { return Boolean(open.run?.description.stage); },
  get problem() { return element("problem").hidden || element("problem").classList.contains("mild") ? null : element("problem").textContent; },
  get comparison() { return element("comparison").textContent; },
  get selected() { return open.run?.description.bodies[panel.body]?.name ?? null; },
  get drawn() { return { count: drawn.count, run: drawn.run, frame: drawn.frame }; },
  /** How a place of the world, m, comes to one of the picture: to (it - center) / size, and that by the matrix `clip`. */
  get view() {
    const { clip, width, height } = drawn.view ?? { clip: [] };
    return { clip: Array.from(clip), width, height, ...open.painter.space };
  },
  get bodies() { return open.run?.description.bodies.map(({ name }) => name) ?? []; },
  /** Location (m) and orientation (x y z w) of a body, by its name or number, in a frame; null until it is there. */
  pose(body, frame = player.frame) {
    const number = typeof body === "number" ? body : (panel.numbers?.get(body) ?? -1);
    return open.run?.pose(number, frame) ?? null;
  },
  seek(frame) { player.pause(); player.seek(frame); redraw(); },
  play() { player.play(); redraw(); },
  pause() { player.pause(); redraw(); },
  reset() { player.reset(); redraw(); },
  /** Resolves when the frame that is wanted now has been drawn, or what `is` asks for. */
  whenDrawn(is = () => drawn.run === open.run?.id && drawn.frame === player.frame && !drawn.dirty) {
    return new Promise((resolve) => {
      drawn.waiting.push(() => (is(window.jabuka) ? (resolve(window.jabuka.drawn), true) : false));
      redraw();
    });
  },
};
