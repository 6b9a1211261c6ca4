// Handles the viewer's input: keys, buttons, pointers.

import { listenToChosen } from "./body/chosen_body.js";
import { copyCamera } from "./saving/copied_camera.js";
import { drawn, element, open, panel, player, plots, redraw, viewpoint } from "./parts.js";
import { toggleHandles } from "./text/handles.js";
import { sceneCamera } from "./picture/picture.js";
import { renderThis } from "./saving/render.js";
import { foldWarnings, refresh } from "./run/runs.js";
import { prepareSaving } from "./saving/save.js";
import { CAN_COMPUTE, CAN_RENDER } from "./source.js";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 10];

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
  sayCamera();
}

function takeCamera() {
  if (!open.run) return;
  viewpoint.take(sceneCamera(open.run, player.position));
  sayCamera();
}

function sayCamera() {
  element("camera").textContent = viewpoint.own ? "Own camera" : "Scene camera";
  element("copy-camera").hidden = !viewpoint.own;
}

function loop(on) {
  player.loop = on;
  element("loop").checked = on;
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
  [["l"], "L", "play it over and over, or once", () => loop(!player.loop)],
  [["c"], "C", "the scene's camera, or one of your own", toggleCamera],
  [["a"], "A", "turn the camera to the left", turn(0.1, 0)],
  [["d"], "D", "turn the camera to the right", turn(-0.1, 0)],
  [["w"], "W", "turn the camera up", turn(0, 0.1)],
  [["s"], "S", "turn the camera down", turn(0, -0.1)],
  [["e"], "E", "come nearer", () => (takeCamera(), viewpoint.approach(0.9))],
  [["q"], "Q", "go away", () => (takeCamera(), viewpoint.approach(1 / 0.9))],
  [["n"], "N", "choose the next body", () => chooseNext(1)],
  [["b"], "B", "choose the body before", () => chooseNext(-1)],
  [["t"], "T", "the text of the scene", () => element("edit").hidden || element("edit").click()],
  [["m"], "M", "move things of the scene in the picture, or not", () => element("move").hidden || toggleHandles()],
  [["r"], "R", "render this frame with POV-Ray", () => renderThis()],
  [["?"], "?", "this list", () => element("keys").showModal()],
].filter(([, key]) => (CAN_RENDER || key !== "R") && (CAN_COMPUTE || !["T", "M"].includes(key)));

function pressed(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
  // The editor lies in a tree of its own, which hides the element that has the focus.
  const [target] = event.composedPath();
  if (target.isContentEditable || target.matches?.("textarea")) return;
  // These keys move the slider of a variable.
  if (target.closest?.("#sliders") && /^( |Arrow.*|Home|End|Page.*)$/.test(event.key)) return;
  const writes = target.matches?.("input:not([type=range]):not([type=checkbox])");
  // In a text field, keys type text. Only the space key stays a command, except in the field for body names.
  if (writes && (event.key !== " " || target === element("body-name"))) return;
  if (target.matches?.("select") && event.key !== " ") return;
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

/** Selects the body at a point of the picture. */
export function choose(x, y) {
  if (!drawn.view) return;
  const canvas = element("picture");
  const scale = canvas.width / canvas.clientWidth;
  panel.choose(open.painter.pick(drawn.view, Math.floor(x * scale), Math.floor(y * scale)));
  redraw();
}

export function listen() {
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
  element("loop").onchange = () => loop(element("loop").checked);
  element("camera").onclick = act(toggleCamera);
  element("move").onclick = act(toggleHandles);
  element("copy-camera").onclick = copyCamera;
  element("view").onchange = act(() => (open.view = Number(element("view").value)));
  element("render").onclick = renderThis;
  element("image-close").onclick = act(() => (element("image").hidden = true));
  prepareSaving();
  element("warnings").onclick = foldWarnings;
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
  listenToChosen();
  element("script-part").ontoggle = redraw;
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
