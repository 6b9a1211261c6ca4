// The source of all data of the page: jabuka itself, in a worker. It has the exports of the preview's source.

import { FONTS } from "./fonts.js";

export const REFUSED = typeof WebAssembly === "object" ? null : "This browser has no WebAssembly, which jabuka needs.";
export const LOST = "jabuka has stopped. Change the scene to start it again.";
export const CAN_RENDER = false;
export const CAN_COMPUTE = true;

/** The time after which a worker that does not take a new scene is replaced, ms. One frame of a hard scene may take hours. */
const PATIENCE = 1000;

/** The module and the fonts, which all workers share. */
let parts;
let isLoaded = false;
let worker;
/** The number of the worker. The numbers of its runs begin with it, so runs of two workers differ. */
let generation = 0;
let asked = 0;
const waiting = new Map();
const listeners = { changed: () => {}, lost: () => {} };
/** The scene that the worker has taken last, or that it will take first. */
let newest;
let taken = true;
let patience;

function failure(message, status) {
  const error = new Error(message);
  error.status = status;
  return error;
}

const outside = (id) => `${generation}.${id}`;

/** Returns a state with the numbers of runs as the page knows them. */
function renamed(state) {
  const runs = Object.values(state.runs).map((run) => ({ ...run, id: outside(run.id) }));
  return { ...state, current: state.current && outside(state.current), runs: Object.fromEntries(runs.map((run) => [run.id, run])) };
}

function stop() {
  worker?.terminate();
  worker = undefined;
  for (const { reject } of waiting.values()) reject(failure("the run has been replaced", 404));
  waiting.clear();
}

async function load() {
  const bytes = async (name) => {
    const response = await fetch(name);
    if (!response.ok) throw new Error(`${name} is not there`);
    return new Uint8Array(await response.arrayBuffer());
  };
  const [module, ...fonts] = await Promise.all([WebAssembly.compileStreaming(fetch("jabuka.wasm")), ...FONTS.map(bytes)]);
  return { module, fonts };
}

async function start() {
  stop();
  const own = ++generation;
  parts ??= load().catch((error) => {
    parts = undefined;
    throw error;
  });
  const made = new Worker("worker.js");
  worker = made;
  made.onmessage = ({ data }) => own === generation && receive(data);
  made.onerror = () => own === generation && broken("the worker could not be started");
  try {
    const loaded = await parts;
    isLoaded = true;
    if (own === generation) made.postMessage(loaded);
  } catch (error) {
    broken(error.message);
  }
}

function receive({ id, bytes, error, status, state, began, broken: why }) {
  if (why) return broken(why);
  if (began) {
    clearTimeout(patience);
    taken = true;
    return;
  }
  if (state) {
    listeners.changed(renamed(state));
    return;
  }
  const { resolve, reject } = waiting.get(id) ?? {};
  waiting.delete(id);
  if (error !== undefined) reject?.(failure(error, status));
  else resolve?.(bytes);
}

/** Tells the page that the worker has ended. The next scene starts a new one. */
function broken(why) {
  clearTimeout(patience);
  taken = true;
  stop();
  const problem = `jabuka has stopped: ${why}\n\nChange the scene to start it again.`;
  listeners.changed({ current: null, integrator: null, problem, warnings: null, runs: {}, text: newest?.version ?? null, diagnostics: [] });
}

/** Gives the worker another scene: its path, and the text or the bytes of each of its files by path. */
export function setScene(scene, files) {
  // The numbers of scenes are the versions of their texts.
  newest = { scene, files, version: String(Number(newest?.version ?? 0) + 1) };
  if (!worker) start();
  taken = false;
  worker.postMessage(newest);
  clearTimeout(patience);
  patience = setTimeout(replace, PATIENCE);
}

/** The text is a part of the page from the beginning. The time without a further key after which it is read, ms. */
export const TEXT = { isOpen: true, pause: 120 };

export async function readText() {
  const { scene, files, version } = newest;
  return { file: scene, text: files[scene], version };
}

export async function writeText(text) {
  const { scene, files } = newest;
  setScene(scene, { ...files, [scene]: text });
  return newest.version;
}

/** Starts another worker, because the present one does not take the newest scene. */
function replace() {
  if (taken) return;
  if (!isLoaded) {
    patience = setTimeout(replace, PATIENCE);
    return;
  }
  start();
  worker.postMessage(newest);
  patience = setTimeout(replace, 10 * PATIENCE);
}

function ask(path, frames, more = {}) {
  const [, before, number, rest] = /^(\/api\/runs\/)([^/]*)(.*)$/.exec(path) ?? [];
  const [of, id] = number?.split(".") ?? [generation];
  if (!worker || Number(of) !== generation) return Promise.reject(failure("the run has been replaced", 404));
  const serial = ++asked;
  const answer = new Promise((resolve, reject) => waiting.set(serial, { resolve, reject }));
  worker.postMessage({ id: serial, request: { path: number === undefined ? path : before + id + rest, frames, ...more } });
  return answer;
}

export async function binary(path, frames) {
  return (await ask(path, frames)).buffer;
}

export async function json(path, frames) {
  return JSON.parse(new TextDecoder().decode(await ask(path, frames)));
}

export async function startVariant(variant) {
  const answer = await ask("/api/variants", undefined, { variant });
  const progress = JSON.parse(new TextDecoder().decode(answer));
  return { ...progress, id: outside(progress.id) };
}

export function follow(changed, lost) {
  Object.assign(listeners, { changed, lost });
}

export const MOVED = "";

/** Sliders always write into the text. */
export const setVariable = undefined;

/** POV-Ray does not run in a browser. The page does not offer it. */
export function renderFrame() {
  return Promise.reject(failure("POV-Ray does not run in a browser", 404));
}
