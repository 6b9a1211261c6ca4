// Composes the picture of a frame.

import { showChosen } from "../body/chosen_body.js";
import { drawHandles, heldCamera, showHandles } from "../text/handles.js";
import { camera as cameraLines, Lines, thing, trail } from "./lines.js";
import { axes, encoded, isThere, length, short, sub } from "../math.js";
import { showScriptPart } from "../body/script_part.js";
import { PARTICLE } from "../run/run.js";
import { drawn, element, open, panel, player, plots, texts, viewpoint } from "../parts.js";
import { layout } from "./texts.js";

/** The largest number of points of all trails together. */
const MOST_POINTS = 60_000;
const NONE = new Float64Array();
/** The pose of a body that is not drawn. */
const NOWHERE = Array(7).fill(NaN);

let before;

/** Returns the scene's camera at a position of the film: at a frame, or interpolated between two frames. */
export function sceneCamera(run, position) {
  const frame = Math.floor(position + 1e-9);
  const stage = run.description.stage;
  const here = run.shownIn(frame, open.view)?.camera;
  const then = position - frame > 1e-6 ? run.shownIn(frame + 1, open.view)?.camera : undefined;
  if (here && then) return betweenCameras(here, then, position - frame);
  if (here) return here;
  if (stage) return stage.cameras[Math.min(open.view, stage.cameras.length - 1)];
  const { center, size } = open.painter.space;
  return { location: [center[0] + 0.16 * 1.6 * size, center[1] + 0.11 * 1.6 * size, center[2] + 1.6 * size], look_at: center, angle: 40 };
}

function betweenCameras(a, b, part) {
  const mixed = (p, q) => p + part * (q - p);
  const point = (p, q) => p.map((number, i) => mixed(number, q[i]));
  return { ...a, location: point(a.location, b.location), look_at: point(a.look_at, b.look_at), up: a.up && b.up && point(a.up, b.up), angle: a.angle && mixed(a.angle, b.angle) };
}

/** Returns the distance from a viewpoint to the nearest body or the ground, m. */
function nearestTo(run, at, eye) {
  const { pieces, stage } = run.description;
  let nearest = stage?.ground ? Math.abs(eye[1] - stage.ground.height) : Infinity;
  for (const { body, location, scale, plane } of pieces) {
    const place = at(body);
    if (!isThere(place)) continue;
    const away = Math.hypot(place[0] - eye[0], place[1] - eye[1], place[2] - eye[2]);
    const reach = plane ? 0 : length(location) + 1.8 * Math.max(...scale);
    // Inside the bounding sphere of a long body, the distance to its surface is unknown, so a small one is assumed.
    nearest = Math.min(nearest, plane ? away : Math.max(away - reach, 0.02 * reach));
  }
  return nearest;
}

/** Draws the present position of the film on the page. */
function draw() {
  const canvas = element("picture");
  const picture = compose({ width: canvas.clientWidth, height: canvas.clientHeight, scale: Math.min(2, window.devicePixelRatio || 1) });
  if (!picture) return;
  const { run, view, layout, camera } = picture;
  const { position, frame } = player;
  drawn.dirty = false;
  texts.show(layout);
  showHandles(run, view);
  const film = element("film");
  film.hidden = viewpoint.own;
  const [left, top, w, h] = view.rectangle;
  Object.assign(film.style, { left: `${left}px`, top: `${top}px`, width: `${w}px`, height: `${h}px` });
  element("time").value = frame;
  element("clock").value = `${short(player.time, 6)} s, frame ${frame} of ${run.frames - 1}`;
  element("play").classList.toggle("playing", player.playing);
  element("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
  status(run);
  plots.mark(player.time);
  panel.show(frame);
  showScriptPart();
  Object.assign(drawn, { count: drawn.count + 1, run: run.id, frame, position, view, camera });
  for (const one of drawn.waiting.splice(0)) if (!one()) drawn.waiting.push(one);
}

/**
 * Draws the present position of the film into the canvas. The picture is `width` x `height` pixels of a page, each `scale` pixels of the canvas
 * wide. Returns its run, its view, and what stands over it (`layout`); undefined while its data are being fetched. `seen` is the aspect ratio of
 * the picture on the page, for a picture that is saved: that one has no marks of the page, and shows at least the same part of the scene.
 */
export function compose({ width, height, scale, seen }) {
  const { run } = open;
  if (!run || !open.painter?.batches.run) return undefined;
  const { position, frame } = player;
  run.want(frame, open.view);
  const at = run.posesAt(position);
  if (!at) return undefined;
  // While paused, a frame is drawn only when all of its data has been fetched.
  const present = run.shownIn(frame, open.view);
  const particles = run.description.particles ? run.particlesIn(frame) : NONE;
  if (!player.playing && ((run.hasShown && !present) || !particles)) return undefined;
  // While playing, missing data is replaced by that of the last complete frame of the same run and camera.
  if (present) run.latest = { view: open.view, shown: present };
  const shown = present ?? (run.latest?.view === open.view ? run.latest.shown : undefined);
  open.painter.resize(Math.round(width * scale), Math.round(height * scale));
  const stage = run.description.stage;
  const camera = heldCamera() ?? (!present && shown ? shown.camera : sceneCamera(run, position));
  const view = viewpoint.view(camera, open.painter.space, width, height, run.description.size, (eye) => nearestTo(run, at, eye), seen);
  const drawnAt = (body) => (shown?.drawn.length && !shown.drawn[body] ? NOWHERE : at(body));
  open.painter.place("run", drawnAt, (body) => shown?.scale[body] ?? 1);
  open.painter.look(shown, stage?.maps ?? []);
  if (particles) open.painter.scatter(particles);
  const lines = new Lines();
  streaks(lines, open.painter.scattered ?? NONE);
  drawLines(lines, run, shown, at);
  if (!seen) markPage(lines, run, camera, at, view);
  strobes(run, position, at);
  if (open.other) placeOther(run);
  open.painter.draw(view, shown?.lights ?? stage?.lights ?? [], lines, drawnAt);
  const over = layout(shown, view, open.painter.space, (body) => at(body).slice(0, 3), triads(run, shown, at), stage?.plots ?? [], run.fonts);
  return { run, view, camera, layout: over };
}

/** Adds the marks of the page: around the chosen body, the arrows of handles, and the outline of the scene's camera as the viewer's own sees it. */
function markPage(lines, run, camera, at, view) {
  if (panel.body !== undefined && !run.description.pieces.every((piece) => piece.body !== panel.body)) {
    mark(lines, view, at(panel.body), run.description.pieces.filter((piece) => piece.body === panel.body && !piece.plane));
  }
  drawHandles(lines, run);
  if (viewpoint.own && run.description.stage && !camera.width) outlineCamera(lines, camera, run.description.size);
}

/** Returns the triads of axes to draw: bodies that are triads, and the axes drawn on other bodies. */
function triads(run, shown, at) {
  const bodies = run.description.bodies.flatMap(({ axes: length }, body) => {
    if (!length) return [];
    const here = at(body);
    return isThere(here) ? [{ location: here.slice(0, 3), orientation: here.slice(3), length }] : [];
  });
  return [...bodies, ...(shown?.things ?? []).filter((each) => each.form === "axes")];
}

/** Adds the streaks of particles as lines. */
function streaks(lines, particles) {
  for (let i = 0; i < particles.length; i += PARTICLE) {
    const [x, y, z, a, b, c, radius, ...color] = particles.subarray(i, i + PARTICLE);
    if (x !== a || y !== b || z !== c) lines.add([a, b, c], [x, y, z], 0, color.slice(0, 3), radius);
  }
}

function drawLines(lines, run, shown, at) {
  const stage = run.description.stage;
  const grid = shown?.grid ?? stage?.grids[Math.min(open.view, stage.grids.length - 1)];
  if (grid) thing(lines, grid);
  const stroke = shown?.stroke ?? 0;
  stage?.trails.forEach((each) => {
    const palette = each.map === null ? undefined : paletteOf(run, each.map);
    trail(lines, run, { ...each, palette, radius: each.radius ?? stroke / 2 }, player.position, MOST_POINTS / stage.trails.length);
  });
  shown?.things.forEach((each) => thing(lines, each));
  showChosen(lines, run, at, player.position);
}

/** Returns the colors of a color map, in sRGB. */
function paletteOf(run, map) {
  run.palettes ??= [];
  return (run.palettes[map] ??= run.description.stage.maps[map].map(encoded));
}

/** Adds four lines around the chosen body, to its left and right, above and below. */
function mark(lines, view, [x, y, z], pieces) {
  if (!pieces.length || Number.isNaN(x)) return;
  const reach = 1.25 * Math.max(...pieces.map((piece) => length(piece.location) + Math.max(...piece.scale)));
  for (const axis of [view.right, view.up]) {
    for (const side of [-1, 1]) {
      const point = (far) => [x + axis[0] * far * side, y + axis[1] * far * side, z + axis[2] * far * side];
      lines.add(point(reach), point(1.35 * reach), open.painter.space.size * 0.0012, [0.1, 0.55, 1]);
    }
  }
}

function outlineCamera(lines, camera, [w, h]) {
  const away = sub(camera.location, camera.look_at);
  const { right, up, back } = axes(camera.location, camera.look_at, camera.up);
  const tangentX = Math.tan((Math.min(camera.angle, 170) * Math.PI) / 360);
  const depth = 0.25 * length(away);
  cameraLines(lines, { location: camera.location, right, up, back, tangentX, tangentY: (tangentX * h) / w, depth }, 0.002 * depth);
}

/** Draws the ghosts that the scene requests: earlier poses of bodies at regular intervals. */
function strobes(run, position, at) {
  if (!run.ghosts.length) return;
  const now = run.timeAt(position);
  const past = run.ghosts.filter((ghost) => ghost.time < now - 1e-6 / run.rate);
  const apart = past.filter(({ body, location, orientation: o }) => {
    const here = at(body);
    const turned = Math.abs(o[0] * here[3] + o[1] * here[4] + o[2] * here[5] + o[3] * here[6]) < 1 - 1e-4;
    return !isThere(here) || turned || length(sub(location, here)) > 1e-4 * open.painter.space.size;
  });
  const key = `${run.id} ${past.length} ${apart.map((ghost) => past.indexOf(ghost)).join()}`;
  if (open.strobes !== key) {
    open.strobes = key;
    open.painter.put("ghosts", apart.map(({ body, color }, pose) => ({ body, pose, color })), true);
  }
  if (apart.length) open.painter.place("ghosts", (i) => [...apart[i].location, ...apart[i].orientation], (i) => apart[i].scale);
}

/** Sets the poses of the compared run, and shows the largest distance between a body and the same body of the shown run. */
function placeOther(run) {
  const { other } = open;
  const position = Math.min(other.positionAt(player.time), other.frames - 1);
  other.want(Math.floor(position + 1e-9), 0);
  const at = other.posesAt(position);
  const here = run.posesAt(player.position);
  if (!at || other.bodies !== run.bodies) return;
  open.painter.place("other", at);
  let [most, which] = [0, 0];
  for (let i = 0; i < run.bodies; i++) {
    const apart = length(sub(at(i).slice(0, 3), here(i).slice(0, 3)));
    if (apart > most) [most, which] = [apart, i];
  }
  const name = run.description.bodies[which]?.name;
  element("comparison").textContent = `${other.description.integrator} as a ghost: ${most > 0 ? `${short(most, 3)} m apart (${name})` : "at the same places"}`;
}

function status(run) {
  const { recorded, frames } = run.progress ?? { recorded: 0, frames: 0 };
  const { stage, settled } = run.description;
  const step = settled ? `, timestep ${short(stage.timestep)} s, drift ${short(100 * stage.drift, 2)} %` : "";
  const so = recorded < frames ? `simulated ${recorded} of ${frames} frames` : `${run.bodies} ${run.bodies === 1 ? "body" : "bodies"}, ${run.description.integrator}${step}`;
  element("status").textContent = so;
}

export function tick(now) {
  const seconds = before === undefined ? 0 : (now - before) / 1000;
  before = now;
  if (player.playing && !open.saving) {
    player.advance(seconds);
    drawn.dirty = true;
  }
  if (drawn.dirty && !open.saving) draw();
  requestAnimationFrame(tick);
}
