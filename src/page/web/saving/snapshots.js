// Draws pictures that are saved: in any size, with all that stands over them, and without the marks of the page.

import { loadFonts, paintOverlay } from "../picture/overlay.js";
import { drawn, element, open, player, redraw, viewpoint } from "../parts.js";
import { compose } from "../picture/picture.js";
import { BUDGET } from "../run/run.js";

/** The width of the page whose texts and lines a larger picture has, in pixels. Its details then look the same in each size. */
const USUAL_WIDTH = 1280;

/** Returns the size of the picture as it is shown now: pixels across and down, and pixels for each of the page's. */
export function shownSize() {
  const canvas = element("picture");
  const scale = canvas.width / canvas.clientWidth;
  const [width, height] = viewpoint.own ? [canvas.clientWidth, canvas.clientHeight] : drawn.view.rectangle.slice(2);
  return { width: Math.round(width * scale), height: Math.round(height * scale), scale };
}

/** Fetches all data that the pictures of a frame need. */
export async function fetchFrame(frame) {
  const { run, other, view } = open;
  await run.ready(frame, view);
  // Trails need the frames before, as far as there is room for them.
  if (run.description.stage?.trails.length && 2 * frame * run.frameBytes < BUDGET) {
    for (let first = 0; first < frame; first += run.together) {
      const last = Math.min(first + run.together - 1, frame);
      if (!run.poses(last)) await run.fetchPoses(first / run.together, run.progress.recorded);
    }
  }
  if (!other) return;
  const beside = Math.floor(Math.min(other.positionAt(run.timeAt(frame)), other.frames - 1));
  for (const next of [beside, beside + 1]) await other.ready(next, 0);
}

/** Takes pictures of one size. While it does, the page draws nothing. */
export class Snapshots {
  constructor({ width, height, scale = Math.max(1, width / USUAL_WIDTH) }) {
    Object.assign(this, { width, height, scale });
    const { clientWidth, clientHeight } = element("picture");
    this.seen = clientWidth / clientHeight;
    this.canvas = Object.assign(document.createElement("canvas"), { width, height });
    // Without transparency, everything is opaque that the graphics processor has left transparent.
    this.context = this.canvas.getContext("2d", { alpha: false });
    this.ground = getComputedStyle(element("stage")).backgroundColor;
  }

  async begin() {
    await loadFonts();
    this.before = { run: open.run, position: player.position };
    open.saving = true;
    element("stage").classList.add("saving");
  }

  /** Goes back to what was shown before. */
  end() {
    open.saving = false;
    element("stage").classList.remove("saving");
    const { run, position } = this.before ?? {};
    if (open.run === run) player.position = position;
    redraw();
  }

  /** Paints the picture of a frame to the canvas. */
  async take(frame) {
    const { context, width, height, scale, seen, before } = this;
    await fetchFrame(frame);
    if (open.run !== before.run) throw new Error("The scene has changed.");
    player.seek(frame);
    const picture = compose({ width: width / scale, height: height / scale, scale, seen });
    if (!picture) throw new Error(`Frame ${frame} cannot be drawn: its data are missing.`);
    if (!open.painter.isWhole) throw new Error(`The graphics processor has no room for ${width} × ${height} pixels: choose a smaller size.`);
    context.resetTransform();
    context.fillStyle = this.ground;
    context.fillRect(0, 0, width, height);
    context.drawImage(open.painter.canvas, 0, 0);
    context.scale(scale, scale);
    paintOverlay(context, picture.layout);
  }
}

/** Returns the picture of the present frame as PNG. */
export async function pictureFile(size) {
  const shots = new Snapshots(size);
  try {
    await shots.begin();
    await shots.take(player.frame);
  } finally {
    shots.end();
  }
  return new Promise((resolve, reject) => {
    shots.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The browser has no room for this picture: choose a smaller size."))), "image/png");
  });
}
