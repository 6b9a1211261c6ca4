// The text of the scene, which the page shows and edits. While it is open, sliders write into it.

import { element, open } from "./parts.js";
import { TEXT, json, readText, writeText } from "./source.js";

/** The time after which a slider that is moved again begins another step that can be undone, ms. */
const STEP_TIME = 800;

/** The text as the page has it, the file in which it stands, and the version of the source's text on which it is based. */
const scene = { file: null, text: "", version: null };
/** False while the page has changes that the source does not have. */
let isWritten = true;
let writing;
let timer;
/** The state of the source, and what waits until it has read the text of the page. */
let state = {};
const waiting = [];
let editor;
/** The slider that was moved last, and when. */
let moved = {};

/** Returns the text of the page, and the file in which it stands. */
export const sceneText = () => scene;

/** True while sliders write into the text. */
export const isEdited = () => TEXT.isOpen || !element("editor").hidden;

export function say(text, ...choices) {
  element("said").replaceChildren(text, ...choices);
}

function choice(label, deed) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = label;
  button.onclick = deed;
  return button;
}

const isRead = () => isWritten && state.text === scene.version;

/** The errors and warnings of the text, or null while the source has not read the text of the page. */
export const diagnostics = () => (isRead() ? state.diagnostics : null);

/** Takes the text that the source has, in place of that of the page. */
export async function load() {
  clearTimeout(timer);
  isWritten = true;
  const { file, text, version } = await readText();
  if (!isWritten) return;
  const isOther = file !== scene.file;
  Object.assign(scene, { file, text, version });
  if (isOther) editor?.set(text);
  else editor?.update(text);
  say("");
  check();
}

/** Takes a new state of the source. Its text may have been changed by another program. */
export function takeState(newest) {
  state = newest;
  element("edit").hidden = state.text === null;
  if (!isEdited() || state.text === null) return;
  if (state.text !== scene.version && isWritten && !writing) load().catch((error) => say(error.message));
  else check();
}

function check() {
  if (!isRead()) return;
  editor?.mark(state.diagnostics, scene.file);
  waiting.splice(0).forEach((resolve) => resolve());
}

/** Resolves when the source has read the text of the page. */
async function read() {
  await write();
  if (!isWritten) throw new Error("The text is not saved yet.");
  if (!isRead()) await new Promise((resolve) => waiting.push(resolve));
}

/** Gives the text to the source. */
async function write() {
  clearTimeout(timer);
  if (isWritten) return;
  writing ??= give().finally(() => (writing = undefined));
  await writing;
}

async function give() {
  while (!isWritten) {
    const { text } = scene;
    try {
      scene.version = await writeText(text, scene.version);
    } catch (error) {
      return error.status === 409 ? offer() : say(error.message);
    }
    isWritten = text === scene.text;
  }
  say("");
  check();
}

/** Lets the user choose between the text of the page and that of another program. */
function offer() {
  const keep = async () => {
    ({ version: scene.version } = await readText());
    await write();
  };
  say("Another program has changed the file. ", choice("Take its text", () => load()), " ", choice("Keep this text", keep));
}

function edited(text) {
  scene.text = text;
  isWritten = false;
  clearTimeout(timer);
  timer = setTimeout(write, TEXT.pause);
}

/** Replaces the text, as an edit that can be taken back. */
export function setText(text) {
  editor?.update(text);
  edited(text);
}

/** Writes the value of a slider into the text. */
export async function setInText(variable, value) {
  // Places are those of a text that was read. Another slider or a key may have changed the text since then.
  if (!isRead()) await read();
  const { text } = scene;
  const { current, problem } = state;
  if (problem) throw new Error("The text has an error: mend it first.");
  const { sliders } = await json(`/api/runs/${current}`);
  if (text !== scene.text || !isRead()) return setInText(variable, value);
  const place = sliders.find((slider) => slider.variable === variable)?.place;
  if (!place) throw new Error(`There is no slider of \`${variable}\` any more.`);
  if (place.file !== scene.file) throw new Error(`\`${variable}\` stands in ${place.file}: change it there.`);
  const before = text.split("\n").slice(0, place.line - 1).reduce((sum, line) => sum + line.length + 1, 0);
  const line = text.slice(before).split("\n", 1)[0];
  const start = [...line].slice(0, place.column - 1).join("").length;
  const [number] = /^[-+]?[\d._]+(?:[eE][-+]?\d+)?/.exec(line.slice(start)) ?? [];
  if (number === undefined) throw new Error(`The value of \`${variable}\` is a formula: change it in the text.`);
  const from = before + start;
  // The values that a slider passes on its way are one step.
  const begins = moved.variable !== variable || performance.now() - moved.time > STEP_TIME;
  moved = { variable, time: performance.now() };
  if (editor) editor.change(from, from + number.length, String(value), begins);
  else edited(text.slice(0, from) + String(value) + text.slice(from + number.length));
  await read();
}

/** Loads the editor, which is large, after the first picture. */
async function loadEditor() {
  if (editor) return;
  await window.jabuka.whenDrawn(() => element("nothing").hidden || element("problem").hidden === false);
  const { makeEditor } = await import("./editor.js");
  if (editor) return;
  editor = makeEditor(element("text"), scene.text, edited);
  window.jabuka.editor = editor;
  check();
}

async function toggle() {
  const pane = element("editor");
  pane.hidden = !pane.hidden;
  element("edit").setAttribute("aria-expanded", String(!pane.hidden));
  if (pane.hidden) return;
  try {
    if (scene.version !== state.text) await load();
    await loadEditor();
    editor.view.focus();
  } catch (error) {
    say(error.message);
  }
}

/** Lets the user open the text. It is open from the beginning if the source says so. */
export function listenToText() {
  element("edit").onclick = toggle;
  element("editor").hidden = !TEXT.isOpen;
  element("edit").setAttribute("aria-expanded", String(TEXT.isOpen));
  window.addEventListener("beforeunload", (event) => isWritten || event.preventDefault());
  // A page that shows this one in a frame may have hidden the text.
  if (TEXT.isOpen) setTimeout(() => element("editor").hidden || loadEditor());
}
