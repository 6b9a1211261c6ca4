// The page: what the server says → what is seen. `window.jabuka` is for programs that look at it.

import { arrow, axes, between, camera as cameraLines, coil, Lines, trail } from "./lines.js";
import { short, unit, sub, length } from "./math.js";
import { Painter } from "./painter.js";
import { Panel } from "./panel.js";
import { Player } from "./player.js";
import { Plots } from "./plots.js";
import { Run } from "./run.js";
import { follow, post, token } from "./server.js";
import { Texts } from "./texts.js";
import { Viewpoint } from "./viewpoint.js";

const element = (id) => document.getElementById(id);
const player = new Player();
const viewpoint = new Viewpoint();
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 10];

/** What is open: the server's state, the run that is shown, the one it is compared with. */
const open = { state: null, run: null, other: null, view: 0, serial: 0, gone: false };
/** What has been drawn last. */
const drawn = { count: 0, run: null, frame: -1, view: null };
const waiting = [];
let painter;
let dirty = true;
let before;

const panel = new Panel({ name: element("body-name"), names: element("body-names"), values: element("body-values") });
const plots = new Plots({ canvas: element("plot"), choice: element("plotted"), legend: element("legend"), drift: element("drift") });
const texts = new Texts(element("texts"));

// ---- what the server says ------------------------------------------------------------------------------------------

/** Takes in a state: which run is the scene's now, how far runs are, what is wrong. */
async function changed(state) {
  open.state = state;
  open.gone = false;
  sayProblem();
  for (const run of [open.run, open.other]) {
    const progress = run && state.runs[run.id];
    // When a run is finished, it is known where its camera stands.
    if (progress && (await run.progressed(progress)) && run === open.run) paint(run);
  }
  await refresh();
  // A run that had diverged before it was opened says so only now.
  sayProblem();
  redraw();
}

/** Opens the runs that should be shown, if they are others than before. */
async function refresh() {
  const serial = ++open.serial;
  const { state } = open;
  if (!state?.current) return;
  if (open.scene !== state.current) {
    // Another scene: what was chosen for the old one is asked for again, of the new one.
    open.scene = state.current;
    open.wanted = {};
  }
  const [own, other] = [method("integrator", "step"), method("other-integrator", "other-step")];
  const first = await wanted("first", own, state.current);
  if (serial !== open.serial) return;
  if (first && first !== open.run?.id) await show(first, serial);
  if (serial !== open.serial) return;
  if (!other.integrator) delete open.wanted.second;
  const second = other.integrator ? await wanted("second", other, null) : null;
  if (serial !== open.serial) return;
  const problems = [open.wanted.first?.problem, open.wanted.second?.problem].filter(Boolean);
  element("method-problem").textContent = problems.join("\n\n");
  element("method-problem").hidden = !problems.length;
  if (second !== (open.other?.id ?? null)) await compare(second, serial);
  if (open.run) plots.take([open.run, ...(open.other ? [open.other] : [])], panel.body);
}

/** The method that is chosen; an empty one is the scene's. */
function method(integrator, step) {
  return { integrator: element(integrator).value, step: element(step).value.trim() };
}

/** The number of the run by a method, which the server begins if need be. */
async function wanted(which, { integrator, step }, usual) {
  if (usual && !integrator && !step) {
    delete open.wanted[which];
    return usual;
  }
  const key = `${integrator} ${step}`;
  open.wanted[which] ??= {};
  if (open.wanted[which].key === key) return open.wanted[which].id;
  try {
    const current = open.run?.description.integrator;
    const order = { integrator: integrator || open.integrator || current || "euler-cromer", step };
    const progress = await (await post("/api/variants", order)).json();
    open.wanted[which] = { key, id: progress.id };
    open.state.runs[progress.id] ??= progress;
    return progress.id;
  } catch (error) {
    open.wanted[which] = { key, id: which === "first" ? open.run?.id ?? usual : null, problem: error.message };
    return open.wanted[which].id;
  }
}

async function opened(id) {
  const run = await Run.open(id);
  const progress = open.state.runs[id];
  if (progress) await run.progressed(progress);
  return run;
}

/** Shows a run, at the same time as the one before. */
async function show(id, serial) {
  let run;
  try {
    const opening = opened(id);
    // To start the graphics processor takes as long as to fetch a run, so both are done at once.
    if (!startPainter()) return;
    run = await opening;
  } catch (error) {
    // It has been replaced meanwhile; the next state tells by what.
    if (error.status === 404) return;
    throw error;
  }
  if (serial !== open.serial) return run.close();
  // The new run is not shown before there is something of it at this time.
  const frame = run.frameAt(player.time);
  run.changed = () => redraw();
  await run.want(Math.min(frame, Math.max(0, (run.progress?.recorded ?? 1) - 1)), open.view);
  if (serial !== open.serial) return run.close();
  open.run?.close();
  open.run = run;
  if (id === open.state.current) open.integrator = run.description.integrator;
  if (open.view > run.description.views.length) open.view = 0;
  player.take(run);
  paint(run);
  panel.take(run);
  describe(run);
  if (open.other) await compare(open.other.id, serial);
}

/** Makes the picture that of a run. */
function paint(run) {
  painter.take(run);
  open.strobes = null;
  if (open.other) painter.put("other", run.description.bodies.map((_, body) => ({ body, pose: body })));
}

async function compare(id, serial) {
  if (id === null) {
    open.other?.close();
    open.other = null;
    painter.release("other");
    element("comparison").textContent = "";
    return;
  }
  const run = open.other?.id === id ? open.other : await opened(id);
  if (serial !== open.serial && run !== open.other) return run.close();
  if (open.other !== run) open.other?.close();
  open.other = run;
  run.changed = () => redraw();
  paint(open.run);
}

/** Makes what draws, at the first time; tells whether it is there. */
function startPainter() {
  if (painter !== undefined) return painter !== null;
  try {
    painter = new Painter(element("picture"));
  } catch (error) {
    painter = null;
    element("nothing").textContent = error.message;
    element("nothing").hidden = false;
  }
  return painter !== null;
}

/** What stays the same while a run is shown. */
function describe(run) {
  const { description } = run;
  const title = description.title ?? description.name;
  document.title = `${title} – jabuka`;
  element("title").textContent = title;
  element("time").max = run.frames - 1;
  for (const [id, none] of [["integrator", `scene: ${open.integrator}`], ["other-integrator", "nothing"]]) {
    const select = element(id);
    const value = select.value;
    const options = description.methods.map(({ name, summary }) => Object.assign(new Option(name), { title: summary }));
    select.replaceChildren(new Option(none, ""), ...options);
    select.value = value;
  }
  element("step").placeholder = short(description.step);
  element("other-step").placeholder = short(description.step);
  const view = element("view");
  view.replaceChildren(new Option("main camera", 0), ...description.views.map((name, i) => new Option(name, i + 1)));
  view.value = open.view;
  view.hidden = description.views.length === 0;
  element("nothing").hidden = true;
}

function sayProblem() {
  const { state, gone } = open;
  const problem = element("problem");
  const run = open.run && state?.runs[open.run.id];
  const wrong = gone ? "The server does not answer: `jabuka preview` has ended, or the connection is lost." : state?.problem ?? run?.problem;
  const mild = [state?.warnings, run?.warnings].filter(Boolean).join("");
  problem.textContent = wrong || mild;
  problem.classList.toggle("mild", !wrong);
  problem.hidden = !(wrong || mild);
  if (state && !state.current && wrong) {
    element("nothing").textContent = "The scene has errors. It is shown as soon as they are mended.";
    element("nothing").hidden = false;
  }
}

// ---- the picture ---------------------------------------------------------------------------------------------------

function redraw() {
  dirty = true;
}

/** The camera of the scene at the position of the film. */
function sceneCamera(run, frame) {
  const stage = run.description.stage;
  const shown = run.shownIn(frame, open.view)?.camera;
  if (shown) return shown;
  if (stage) return stage.cameras[Math.min(open.view, stage.cameras.length - 1)];
  const { center, size } = painter.space;
  return { location: [center[0] + 0.16 * 1.6 * size, center[1] + 0.11 * 1.6 * size, center[2] + 1.6 * size], look_at: center, angle: 40 };
}

/** Where each body of a run is at a position of the film: that of a frame, or between two. */
function posesAt(run, position) {
  const frame = Math.min(Math.floor(position + 1e-9), run.frames - 1);
  const from = run.poses(frame);
  if (!from) return undefined;
  const part = position - frame;
  const to = part > 1e-6 ? run.poses(frame + 1) : undefined;
  const turns = 3 * run.bodies;
  return (i) => {
    const [p, q] = [3 * i, turns + 4 * i];
    const here = [from[p], from[p + 1], from[p + 2], from[q], from[q + 1], from[q + 2], from[q + 3]];
    if (!to) return here;
    const then = [to[p], to[p + 1], to[p + 2], to[q], to[q + 1], to[q + 2], to[q + 3]];
    const sign = here[3] * then[3] + here[4] * then[4] + here[5] * then[5] + here[6] * then[6] < 0 ? -1 : 1;
    const mixed = here.map((a, k) => a + part * ((k < 3 ? 1 : sign) * then[k] - a));
    const norm = Math.hypot(mixed[3], mixed[4], mixed[5], mixed[6]) || 1;
    return mixed.map((a, k) => (k < 3 ? a : a / norm));
  };
}

function draw() {
  const { run } = open;
  if (!run || !painter?.batches.run) return;
  const { position, frame } = player;
  run.want(frame, open.view);
  const at = posesAt(run, position);
  if (!at) return;
  // A frame that stands still is drawn when all of it is there.
  const shown = run.shownIn(frame, open.view);
  if (!player.playing && run.description.shows && run.description.stage && !shown) return;
  dirty = false;
  const canvas = element("picture");
  const scale = Math.min(2, window.devicePixelRatio || 1);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const stage = run.description.stage;
  const camera = sceneCamera(run, frame);
  const view = viewpoint.view(camera, painter.space, width, height, run.description.size);
  painter.place("run", at);
  const lines = new Lines();
  drawLines(lines, run, shown, at);
  if (viewpoint.own && stage && !camera.width) outlineCamera(lines, camera, run.description.size);
  strobes(run, position, at);
  if (open.other) placeOther(run);
  painter.draw(view, shown?.lights ?? stage?.lights ?? [], lines, at);
  texts.show(shown, view, painter.space, (body) => between(run, body, position));
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
  Object.assign(drawn, { count: drawn.count + 1, run: run.id, frame, position, view });
  for (const one of waiting.splice(0)) if (!one()) waiting.push(one);
}

function drawLines(lines, run, shown, at) {
  const stage = run.description.stage;
  stage?.grid.forEach(({ from, to, radius, color }) => lines.add(from, to, radius, color));
  stage?.trails.forEach((each) => trail(lines, run, each, player.position));
  shown?.coils.forEach((each) => coil(lines, each));
  shown?.arrows.forEach((each) => arrow(lines, each));
  shown?.axes.forEach((each) => axes(lines, each));
  if (panel.body !== undefined && !run.description.pieces.every((piece) => piece.body !== panel.body)) {
    mark(lines, at(panel.body), run.description.pieces.filter((piece) => piece.body === panel.body && !piece.plane));
  }
}

/** A cross of lines around the chosen body. */
function mark(lines, [x, y, z], pieces) {
  if (!pieces.length) return;
  const reach = 1.25 * Math.max(...pieces.map((piece) => length(piece.location) + Math.max(...piece.scale)));
  for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
    for (const side of [-1, 1]) {
      const point = (far) => [x + axis[0] * far * side, y + axis[1] * far * side, z + axis[2] * far * side];
      lines.add(point(reach), point(1.35 * reach), painter.space.size * 0.0012, [0.1, 0.55, 1]);
    }
  }
}

function outlineCamera(lines, camera, [w, h]) {
  const away = sub(camera.location, camera.look_at);
  const back = unit(away, [0, 0, 1]);
  const right = unit([back[2], 0, -back[0]], [1, 0, 0]);
  const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]];
  const tangentX = Math.tan((Math.min(camera.angle, 170) * Math.PI) / 360);
  const depth = 0.25 * length(away);
  cameraLines(lines, { location: camera.location, right, up, back, tangentX, tangentY: (tangentX * h) / w, depth }, 0.002 * depth);
}

/** The ghosts that the scene asks for, as a stroboscope shows them. */
function strobes(run, position, at) {
  if (!run.ghosts.length) return;
  const now = position / run.rate;
  const past = run.ghosts.filter((ghost) => ghost.time < now - 1e-6 / run.rate);
  const apart = past.filter(({ body, location, orientation: o }) => {
    const here = at(body);
    const turned = Math.abs(o[0] * here[3] + o[1] * here[4] + o[2] * here[5] + o[3] * here[6]) < 1 - 1e-4;
    return turned || length(sub(location, here)) > 1e-4 * painter.space.size;
  });
  const key = `${run.id} ${past.length} ${apart.length}`;
  if (open.strobes !== key) {
    open.strobes = key;
    painter.put("ghosts", apart.map(({ body }, pose) => ({ body, pose })), true);
  }
  if (apart.length) painter.place("ghosts", (i) => [...apart[i].location, ...apart[i].orientation]);
}

/** Places the run that is compared with, and says how far apart the two are. */
function placeOther(run) {
  const { other } = open;
  const position = Math.min(player.time * other.rate, other.frames - 1);
  other.want(Math.floor(position + 1e-9), 0);
  const at = posesAt(other, position);
  const here = posesAt(run, player.position);
  if (!at || other.bodies !== run.bodies) return;
  painter.place("other", at);
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
  const stage = run.description.stage;
  const step = stage ? `, timestep ${short(stage.timestep)} s, drift ${short(100 * stage.drift, 2)} %` : "";
  const so = recorded < frames ? `simulated ${recorded} of ${frames} frames` : `${run.bodies} ${run.bodies === 1 ? "body" : "bodies"}, ${run.description.integrator}${step}`;
  element("status").textContent = so;
}

function tick(now) {
  const seconds = before === undefined ? 0 : (now - before) / 1000;
  before = now;
  if (player.playing) {
    player.advance(seconds);
    dirty = true;
  }
  if (dirty) draw();
  requestAnimationFrame(tick);
}

// ---- what the viewer does ------------------------------------------------------------------------------------------

function act(deed) {
  return () => {
    deed();
    redraw();
  };
}

function chooseNext(by) {
  const { run } = open;
  if (run?.bodies) panel.choose(((panel.body ?? (by > 0 ? -1 : 0)) + by + run.bodies) % run.bodies);
}

function toggleCamera() {
  if (viewpoint.own) viewpoint.own = false;
  else takeCamera();
  element("camera").textContent = viewpoint.own ? "Own camera" : "Scene camera";
}

function takeCamera() {
  if (!open.run) return;
  viewpoint.take(sceneCamera(open.run, player.frame));
  element("camera").textContent = "Own camera";
}

function speed(by) {
  const next = SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(player.speed) + by))];
  player.speed = next;
  element("speed").value = next;
}

const turn = (x, y) => () => {
  takeCamera();
  viewpoint.turn(x, y);
};

const KEYS = [
  [[" "], "Space", "back to the initial state, paused", () => player.reset()],
  [["p", "k"], "P", "play or pause", () => player.toggle()],
  [["ArrowLeft"], "←", "one frame back; with Shift, ten", (event) => player.step(event.shiftKey ? -10 : -1)],
  [["ArrowRight"], "→", "one frame on; with Shift, ten", (event) => player.step(event.shiftKey ? 10 : 1)],
  [["Home"], "Home", "the first frame", () => player.step(-Infinity)],
  [["End"], "End", "the last frame", () => player.step(Infinity)],
  [["+", "="], "+", "faster", () => speed(1)],
  [["-"], "−", "slower", () => speed(-1)],
  [["c"], "C", "the scene's camera, or one of your own", toggleCamera],
  [["a"], "A", "turn the camera to the left", turn(0.1, 0)],
  [["d"], "D", "turn the camera to the right", turn(-0.1, 0)],
  [["w"], "W", "turn the camera up", turn(0, 0.1)],
  [["s"], "S", "turn the camera down", turn(0, -0.1)],
  [["e"], "E", "come nearer", () => (takeCamera(), viewpoint.approach(0.9))],
  [["q"], "Q", "go away", () => (takeCamera(), viewpoint.approach(1 / 0.9))],
  [["n"], "N", "choose the next body", () => chooseNext(1)],
  [["b"], "B", "choose the body before", () => chooseNext(-1)],
  [["r"], "R", "render this frame with POV-Ray", () => renderThis()],
  [["?"], "?", "this list", () => element("keys").showModal()],
];

function pressed(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || element("keys").open) return;
  const writes = event.target.matches?.("input:not([type=range]):not([type=checkbox])");
  // In a text, a space is a space only where names are written.
  if (writes && (event.key !== " " || event.target === element("body-name"))) return;
  if (event.target.matches?.("select") && event.key !== " ") return;
  const found = KEYS.find(([keys]) => keys.includes(event.key) || keys.includes(event.key.toLowerCase()));
  if (!found) return;
  event.preventDefault();
  found[3](event);
  redraw();
}

function watchPointers() {
  const canvas = element("picture");
  const held = new Map();
  let moved = 0;
  canvas.onpointerdown = (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    if (held.size === 1) moved = 0;
  };
  canvas.onpointermove = (event) => {
    const last = held.get(event.pointerId);
    if (!last) return;
    const [x, y] = [event.clientX - last[0], event.clientY - last[1]];
    moved += Math.abs(x) + Math.abs(y);
    if (moved < 4) return;
    takeCamera();
    const height = canvas.clientHeight;
    if (held.size === 2) {
      const [id] = [...held.keys()].filter((other) => other !== event.pointerId);
      const other = held.get(id);
      const far = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]) || 1;
      viewpoint.approach(far(last) / far([event.clientX, event.clientY]));
      viewpoint.shift(x / height / 2, y / height / 2, canvas.clientWidth / height);
    } else if (event.buttons & 6 || event.shiftKey) viewpoint.shift(x / height, y / height, canvas.clientWidth / height);
    else viewpoint.turn((4 * x) / height, (4 * y) / height);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    redraw();
  };
  const end = (event) => {
    held.delete(event.pointerId);
    if (event.type === "pointerup" && moved < 4) choose(event.offsetX, event.offsetY);
  };
  canvas.onpointerup = end;
  canvas.onpointercancel = end;
  canvas.oncontextmenu = (event) => event.preventDefault();
  canvas.onwheel = (event) => {
    event.preventDefault();
    takeCamera();
    viewpoint.approach(Math.exp(Math.max(-100, Math.min(100, event.deltaY)) * 0.0015));
    redraw();
  };
}

/** Chooses the body at a place of the picture. */
function choose(x, y) {
  if (!drawn.view) return;
  const canvas = element("picture");
  const scale = canvas.width / canvas.clientWidth;
  panel.choose(painter.pick(drawn.view, Math.floor(x * scale), Math.floor(y * scale)));
  redraw();
}

// ---- a frame by POV-Ray --------------------------------------------------------------------------------------------

async function renderThis() {
  const { run } = open;
  if (!run || open.rendering) return;
  player.pause();
  redraw();
  const frame = player.frame;
  const [button, image, said, problem] = ["render", "rendered", "render-status", "render-problem"].map(element);
  element("image").hidden = false;
  open.rendering = true;
  button.disabled = true;
  problem.hidden = true;
  try {
    for (const fine of [false, true]) {
      said.textContent = `frame ${frame}: ${fine ? "a draft; the final image is being made …" : "a draft is being made …"}`;
      const bytes = await (await post("/api/render", { run: run.id, frame, view: open.view, fine })).blob();
      URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(bytes);
      image.alt = `Frame ${frame} by POV-Ray`;
      await image.decode();
    }
    said.textContent = `frame ${frame}, final`;
  } catch (error) {
    said.textContent = `frame ${frame}`;
    problem.textContent = error.message;
    problem.hidden = false;
  }
  button.disabled = false;
  open.rendering = false;
}

// ---- the beginning -------------------------------------------------------------------------------------------------

function listen() {
  element("reset").onclick = act(() => player.reset());
  element("back").onclick = act(() => player.step(-1));
  element("forward").onclick = act(() => player.step(1));
  element("play").onclick = act(() => player.toggle());
  element("time").oninput = act(() => {
    player.pause();
    player.seek(Number(element("time").value));
  });
  element("speed").replaceChildren(...SPEEDS.map((s) => new Option(`${s} ×`, s, s === 1, s === 1)));
  element("speed").onchange = () => (player.speed = Number(element("speed").value));
  element("loop").onchange = () => (player.loop = element("loop").checked);
  element("camera").onclick = act(toggleCamera);
  element("view").onchange = act(() => (open.view = Number(element("view").value)));
  element("render").onclick = renderThis;
  element("image-close").onclick = act(() => (element("image").hidden = true));
  element("help").onclick = () => element("keys").showModal();
  for (const id of ["integrator", "step", "other-integrator", "other-step"]) {
    element(id).onchange = async () => {
      await refresh();
      redraw();
    };
  }
  panel.chosen = (body) => {
    if (open.run) plots.take([open.run, ...(open.other ? [open.other] : [])], body);
    redraw();
  };
  plots.seek = (time) => {
    if (!open.run) return;
    player.pause();
    player.seek(open.run.frameAt(time));
    redraw();
  };
  window.addEventListener("keydown", pressed);
  new ResizeObserver(redraw).observe(element("stage"));
  watchPointers();
  const rows = KEYS.map(([, key, what]) => {
    const [row, head, cell, mark] = ["tr", "th", "td", "kbd"].map((tag) => document.createElement(tag));
    mark.textContent = key;
    head.append(mark);
    cell.textContent = what;
    row.append(head, cell);
    return row;
  });
  element("key-table").replaceChildren(...rows);
}

/** For programs: what the page knows and does. */
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
    return { clip: Array.from(clip), width, height, ...painter.space };
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
  whenDrawn(is = () => drawn.run === open.run?.id && drawn.frame === player.frame && !dirty) {
    return new Promise((resolve) => {
      waiting.push(() => (is(window.jabuka) ? (resolve(window.jabuka.drawn), true) : false));
      redraw();
    });
  },
};

function begin() {
  const nothing = element("nothing");
  nothing.hidden = false;
  if (!token) {
    nothing.textContent = "Open the whole address that `jabuka preview` has printed.";
    return;
  }
  nothing.textContent = "…";
  listen();
  let queue = Promise.resolve();
  const lost = () => {
    open.gone = true;
    sayProblem();
  };
  follow((state) => {
    queue = queue.then(() => changed(state)).catch((error) => console.error(error));
  }, lost);
  requestAnimationFrame(tick);
}

begin();
