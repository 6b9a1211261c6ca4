// Handles in the picture, with which the viewer moves things: each stands for a vector of the scene, and writes it into the text.

import { make } from "../elements.js";
import { onPlane, planesOf } from "./handle_planes.js";
import { thing } from "../picture/lines.js";
import { add, length, pixelOf, short, times } from "../math.js";
import { drawn, element, open, panel, player, redraw, viewpoint } from "../parts.js";
import { isEdited, toggleText, say, setInText } from "./scene_text.js";

const UNITS = { point: "m", velocity: "m/s" };
/** The length of the arrow of the fastest body, and the radius of arrows, as parts of the size of the scene. */
const [ARROW, LINE] = [0.22, 0.003];
const ARROW_COLOR = [0.08, 0.33, 0.75];
/** How far the handle of a velocity that is zero stands from its body, px. */
const ASIDE = [26, -26];
/** How far a press of an arrow key moves a handle, in steps of its numbers. */
const STEPS_OF_KEY = 10;
/** How far the pointer moves before a handle does, px. */
const SLACK = 3;
const DIRECTIONS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

let isOn = false;
/** The handle that the viewer has moved, until the page shows the run with its new value. */
let held;
/** The newest value that the text does not have yet. */
let newest;
let isWriting = false;
const buttons = new Map();

/** Returns the camera that the picture keeps while a handle is moved, so that nothing moves below the pointer. */
export const heldCamera = () => held?.camera;

const isShown = () => isOn && player.frame === 0 && !player.playing;

/** Returns the handles that are shown. The camera is seen only from elsewhere. */
function handlesOf({ description: { handles } }) {
  if (!isShown()) return [];
  return handles.filter(({ key, kind, body, value }) => {
    if (key.startsWith("camera.")) return viewpoint.own;
    return kind !== "velocity" || length(value) > 0 || panel.body === body || held?.handle.key === key;
  });
}

/** Returns the time whose way the arrows of velocities show, s. */
function timeOfArrows({ description: { handles } }) {
  if (held) return held.seconds;
  const fastest = Math.max(0, ...handles.filter(({ kind }) => kind === "velocity").map(({ value }) => length(value)));
  return fastest > 0 ? (ARROW * open.painter.space.size) / fastest : 0.2;
}

const valueOf = (handle) => (held?.handle.key === handle.key ? held.value : handle.value);

/** Returns the point at which the arrow of a velocity begins: the location of its body at the start. */
function beginning(run, { body }) {
  const own = run.description.handles.find((handle) => handle.body === body && handle.kind === "point");
  return own ? valueOf(own) : run.pose(body, 0)?.location;
}

/** Returns the point of the world at which a handle stands. */
function pointOf(run, handle) {
  if (handle.kind === "point") return valueOf(handle);
  const from = beginning(run, handle);
  return from && add(from, times(valueOf(handle), timeOfArrows(run)));
}

const inWords = ({ key, kind }, value) => `${key} ${value.map((number) => short(number)).join(", ")} ${UNITS[kind]}`;

/** Adds the arrows of the velocities that have handles. */
export function drawHandles(lines, run) {
  for (const handle of handlesOf(run)) {
    if (handle.kind !== "velocity" || !(length(valueOf(handle)) > 0)) continue;
    const from = beginning(run, handle);
    if (from) thing(lines, { form: "arrow", from, to: pointOf(run, handle), radius: LINE * open.painter.space.size, color: ARROW_COLOR });
  }
}

/** Places the handles of a run over its picture. */
export function showHandles(run, view) {
  const toggle = element("move");
  toggle.hidden = element("edit").hidden || !run.description.handles.length;
  settle(run);
  const wanted = handlesOf(run);
  const keys = new Set(wanted.map(({ key }) => key));
  for (const [key, button] of buttons) {
    if (keys.has(key)) continue;
    button.remove();
    buttons.delete(key);
  }
  for (const handle of wanted) {
    if (!buttons.has(handle.key)) buttons.set(handle.key, element("handles").appendChild(made(handle.key)));
    const button = buttons.get(handle.key);
    button.handle = handle;
    button.classList.toggle("velocity", handle.kind === "velocity");
    const words = inWords(handle, valueOf(handle));
    button.setAttribute("aria-label", words);
    button.dataset.says = words;
    const point = pointOf(run, handle);
    const pixel = point && pixelOf(view, open.painter.space, point);
    button.hidden = !pixel;
    if (!pixel) continue;
    const aside = handle.kind === "velocity" && !(length(valueOf(handle)) > 0) ? ASIDE : [0, 0];
    button.style.transform = `translate(${pixel[0] + aside[0]}px, ${pixel[1] + aside[1]}px) translate(-50%, -50%)`;
  }
}

/** Lets go of a handle whose new value the run has. */
function settle({ description: { handles } }) {
  if (!held?.isReleased || newest || isWriting) return;
  const now = handles.find(({ key }) => key === held.handle.key);
  if (!now || held.axes.every((axis) => now.value[axis] === held.value[axis])) held = undefined;
}

/** Takes hold of a handle. Returns false if there is no picture that shows where it is. */
function hold(handle) {
  const { run } = open;
  const from = run && pointOf(run, handle);
  if (!from || !drawn.view) return false;
  const space = { ...open.painter.space };
  const scale = handle.kind === "velocity" ? 1 / timeOfArrows(run) : 1;
  held = {
    handle, from, space, scale, view: drawn.view, camera: viewpoint.own ? undefined : drawn.camera, seconds: timeOfArrows(run), start: valueOf(handle),
    value: valueOf(handle), axes: [], planes: planesOf(drawn.view, space, from),
  };
  return true;
}

/** Moves the held handle along some axes of the world, and writes its numbers. */
function move(axes, ways, step) {
  const { handle, start, scale } = held;
  const round = (number) => Number((Math.round(number / step) * step).toPrecision(12));
  held.value = [...start];
  axes.forEach((axis, i) => (held.value[axis] = round(start[axis] + ways[i] * scale)));
  held.axes = [...new Set([...held.axes, ...axes])];
  newest = { handle, axes: held.axes, value: held.value, step: held.step };
  write();
  redraw();
}

/** Writes the newest numbers, one after another. Those that have been replaced meanwhile are not written. */
async function write() {
  if (isWriting) return;
  isWriting = true;
  while (newest) {
    const { handle, axes, value, step } = newest;
    newest = undefined;
    try {
      const left = await setInText(handle.key, (description) => editsOf(description, handle, axes, value), step);
      if (left) {
        say(`A formula of \`${handle.key}\` stays as it is: change it in the text.`);
        held = undefined;
      }
    } catch (error) {
      newest = held = undefined;
      say(error.message);
    }
    await new Promise(requestAnimationFrame);
  }
  isWriting = false;
  redraw();
}

/** Returns what is to be changed in the text of a run. */
function editsOf({ handles }, { key }, axes, value) {
  const now = handles.find((handle) => handle.key === key);
  if (!now) throw new Error(`The text has no \`${key}\` that can be moved any more.`);
  if (now.places) return axes.map((axis) => ({ place: now.places[axis], value: value[axis] }));
  return [{ table: now.table, line: `${key.split(".").at(-1)} = [${value.join(", ")}]` }];
}

function made(key) {
  const button = make("button", { type: "button", className: "handle" });
  let begun;
  button.onpointerdown = (event) => {
    if (event.button !== 0) return;
    const { handle } = button;
    if (handle.body !== null) panel.choose(handle.body);
    if (!hold(handle)) return;
    // A drag is one step that can be undone.
    held.step = Symbol(key);
    button.setPointerCapture(event.pointerId);
    const pixel = pixelOf(held.view, held.space, held.from);
    begun = { pointer: [event.clientX, event.clientY], pixel, moves: false };
  };
  button.onpointermove = (event) => {
    if (!begun || !held || held.handle.key !== key) return;
    const way = [event.clientX - begun.pointer[0], event.clientY - begun.pointer[1]];
    begun.moves ||= Math.hypot(...way) > SLACK;
    if (!begun.moves) return;
    const plane = held.planes[event.shiftKey ? 1 : 0];
    const ways = onPlane(held.view, held.space, held.from, plane.axes, [begun.pixel[0] + way[0], begun.pixel[1] + way[1]]);
    if (ways) move(plane.axes, ways, plane.step(held.scale));
  };
  const end = () => {
    begun = undefined;
    if (held) held.isReleased = true;
    redraw();
  };
  button.onpointerup = end;
  button.onpointercancel = end;
  button.onkeydown = (event) => {
    const direction = DIRECTIONS[event.key];
    if (!direction || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (!hold(button.handle)) return;
    const plane = held.planes[event.shiftKey ? 1 : 0];
    const { axis, sign } = plane.along(direction);
    const step = plane.step(held.scale);
    move([axis], [(sign * STEPS_OF_KEY * step) / held.scale], step);
    held.isReleased = true;
  };
  return button;
}

/** Shows or hides the handles. They are those of the start. */
export function toggleHandles() {
  isOn = !isOn;
  element("move").setAttribute("aria-pressed", String(isOn));
  if (!isOn) return;
  player.pause();
  player.seek(0);
  if (!isEdited()) toggleText();
}
