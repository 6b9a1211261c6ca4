// The text of the scene, which the page shows and edits. While it is open, sliders write into it.

import { element, open } from "../parts.js";
import { TEXT, json, readText, writeText } from "../source.js";

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
/** What was written last by `setInText`, and when. */
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
  const isNew = isOther || text !== scene.text;
  Object.assign(scene, { file, text, version });
  if (isOther) editor?.set(text);
  else editor?.update(text);
  if (isNew) say("");
  check();
}

/** Takes a new state of the source. Its text may have been changed by another program. */
export function takeState(newest) {
  state = newest;
  element("edit").hidden = state.text === null;
  // A scene with an error has no picture that could come first.
  if (TEXT.isOpen && state.problem && !element("editor").hidden) loadEditor();
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

/** Gives the text to the source in place of that of another program. */
async function keepText() {
  try {
    ({ version: scene.version } = await readText());
  } catch (error) {
    return say(error.message);
  }
  await give();
}

/** Lets the user choose between the text of the page and that of another program. */
function offer() {
  const keep = async () => {
    // A write that is under way is based on the version before the other program's, and fails.
    await writing;
    writing = keepText().finally(() => (writing = undefined));
  };
  say("Another program has changed the file. ", choice("Take its text", () => (say(""), load())), " ", choice("Keep this text", keep));
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

/**
 * Writes numbers into the text, at places that a description of the run names: `find(description)` returns them, each with its value, or the line
 * that a table lacks. Numbers of the same `step`, or with the same name and soon after each other, are one step that can be undone. A formula is left alone: returns how
 * many are, and fails if nothing else is to be written.
 */
export async function setInText(name, find, step) {
  // Places are those of a text that was read. Another slider or a key may have changed the text since then.
  if (!isRead()) await read();
  const { text } = scene;
  const { current, problem } = state;
  if (problem) throw new Error("The text has an error: mend it first.");
  const description = await json(`/api/runs/${current}`);
  if (text !== scene.text || !isRead()) return setInText(name, find, step);
  const edits = find(description);
  const changes = edits.map((edit) => (edit.table ? addedLine(edit, name) : writtenNumber(edit, name))).filter(Boolean).sort((a, b) => a.from - b.from);
  if (!changes.length) throw new Error(`The value of \`${name}\` is a formula: change it in the text.`);
  // The values that a slider passes on its way are one step.
  const begins = step ? moved.step !== step : moved.name !== name || performance.now() - moved.time > STEP_TIME;
  moved = { name, step, time: performance.now() };
  if (editor) editor.change(changes, begins);
  else edited(changes.reduceRight((all, { from, to, insert }) => all.slice(0, from) + insert + all.slice(to), text));
  await read();
  return edits.length - changes.length;
}

/** Returns the line of the text at a place, where it begins, and where the place is in it. */
function lineAt(place, name) {
  if (place.file !== scene.file) throw new Error(`\`${name}\` stands in ${place.file}: change it there.`);
  const before = scene.text.split("\n").slice(0, place.line - 1).reduce((sum, line) => sum + line.length + 1, 0);
  const line = scene.text.slice(before).split("\n", 1)[0];
  return { before, line, start: [...line].slice(0, place.column - 1).join("").length };
}

/** Returns the change that writes a value in the place of a number. Undefined if a formula stands there. */
function writtenNumber({ place, value }, name) {
  const { before, line, start } = lineAt(place, name);
  const [number] = /^[-+]?[\d._]+(?:[eE][-+]?\d+)?/.exec(line.slice(start)) ?? [];
  const from = before + start;
  return number === undefined ? undefined : { from, to: from + number.length, insert: String(value) };
}

/** Returns the change that adds a line below the header of a table. */
function addedLine({ table, line: added }, name) {
  const { before, line } = lineAt(table, name);
  if (!/^\s*\[[^[\]]+\]\s*(#.*)?$/.test(line)) throw new Error(`The text has no \`${name}\`: write one, then it can be moved.`);
  const from = before + line.length;
  return { from, to: from, insert: `\n${added}` };
}

/** Loads the editor, which is large. */
async function loadEditor() {
  if (editor) return;
  const { makeEditor } = await import("./editor.js");
  if (editor) return;
  editor = makeEditor(element("text"), scene.text, edited);
  window.jabuka.editor = editor;
  check();
}

/** Opens or closes the text. */
export async function toggleText() {
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
  element("edit").onclick = toggleText;
  element("editor").hidden = !TEXT.isOpen;
  element("edit").setAttribute("aria-expanded", String(TEXT.isOpen));
  window.addEventListener("beforeunload", (event) => isWritten || event.preventDefault());
  // The first picture comes first. A page that shows this one in a frame may have hidden the text.
  if (TEXT.isOpen) window.jabuka.whenDrawn().then(() => element("editor").hidden || loadEditor());
}
