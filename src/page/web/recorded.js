// The source of all data of a page that was saved as one file, with its run. It has the exports of the preview's source.

const { state, ...answers } = JSON.parse(document.getElementById("recorded").textContent);
/** The answers that were unpacked, by name: their bytes, and where the part of each frame ends. */
const unpacked = new Map();

export const REFUSED = typeof DecompressionStream === "function" ? null : "This browser is too old to unpack the run.";
export const LOST = "";
export const CAN_RENDER = false;
export const CAN_COMPUTE = false;

function failure(message) {
  const error = new Error(message);
  // The status of what is gone for good: the page does not ask again.
  error.status = 410;
  return error;
}

/** Returns the name of the answer to a request. */
function nameOf(path, { body, view }) {
  const what = path.split("/")[4] ?? "description";
  if (what === "shown") return `shown?view=${view ?? 0}`;
  return body === undefined ? what : `${what}?body=${body}`;
}

async function unpack(answer) {
  const letters = atob(answer.bytes);
  // The letters are not needed any more.
  answer.bytes = "";
  const packed = new Uint8Array(letters.length);
  for (let at = 0; at < packed.length; at++) packed[at] = letters.charCodeAt(at);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let end = 0;
  return { bytes, ends: answer.sizes?.map((size) => (end += size)) };
}

/** Returns the answer for each wanted frame. An answer that does not depend on frames has one part. */
async function parts(path, parameters = {}) {
  const name = nameOf(path, parameters);
  const answer = answers[name];
  if (!answer) throw failure("This file does not hold these values.");
  if (!unpacked.has(name)) unpacked.set(name, unpack(answer));
  const { bytes, ends } = await unpacked.get(name);
  if (!ends) return [bytes];
  const { from = 0, to = ends.length, every = 1 } = parameters;
  const wanted = [];
  for (let frame = from; frame < Math.min(to, ends.length); frame += every) wanted.push(bytes.subarray(ends[frame - 1] ?? 0, ends[frame]));
  return wanted;
}

export async function binary(path, parameters) {
  return new Blob(await parts(path, parameters)).arrayBuffer();
}

export async function json(path, parameters) {
  const found = (await parts(path, parameters)).map((part) => JSON.parse(new TextDecoder().decode(part)));
  // The answer for some frames is the list of those for each.
  return path.endsWith("/shown") ? found.flat() : found[0];
}

export function follow(changed) {
  changed(state);
}

/** The page cannot change the run. */
function refuse() {
  return Promise.reject(failure("This page holds one run, and cannot compute another."));
}

export const startVariant = refuse;
export const TEXT = { isOpen: false, pause: 0 };
export const readText = refuse;
export const writeText = refuse;
export const setVariable = refuse;
export const MOVED = "";
export const renderFrame = refuse;
