// The playground: the page of the preview, with an editor, a shelf of scenes, links and scripts to take along.

import "../../src/page/web/main.js";
import { element, open } from "../../src/page/web/parts.js";
import { save } from "../../src/page/web/saving.js";
import { make } from "./elements.js";
import { linkOf, linked } from "./link.js";
import { makeShelf } from "./shelf.js";
import { json, onRead, onSet, setScene } from "./source.js";

/** The scene that a first visit shows. */
const FIRST = "newtons_cradle";
/** The time without a further key after which the text is read, ms. */
const PAUSE = 120;
/** The time after which a slider that is moved again begins another step that can be undone, ms. */
const STEP_TIME = 800;

/** The scene: its name, its text, and the bytes of its other files by path. */
const scene = { name: "", text: "", files: {} };
let editor;
let timer;

const said = make("p", { id: "said" });
said.setAttribute("role", "status");
const field = make("div", { id: "text" });
const button = (label, title, deed) => make("button", { type: "button", textContent: label, title, onclick: deed });
const scripts = button("Scripts", "Save the POV-Ray scripts of all frames as a zip file", takeScripts);
const tools = make("div", { id: "tools" }, button("Examples", "Choose a scene", () => shelf.show()), button("Copy link", "Copy a link that holds this scene", copyLink), scripts);
tools.setAttribute("role", "group");
tools.setAttribute("aria-label", "Scene");
const pane = make("section", { id: "editor" }, tools, field, said);
pane.setAttribute("aria-label", "Text of the scene");
const shelf = makeShelf(async (name) => {
  await openExample(name);
  history.replaceState(null, "", `#gallery=${name}`);
});

/** Reads the text. Resolves when that is done. */
function read() {
  clearTimeout(timer);
  sent = scene.text;
  setScene(path(), { ...scene.files, [path()]: scene.text });
  return new Promise((resolve) => waiting.push(resolve));
}

const path = () => `${scene.name}.toml`;
/** What waits for the text to be read. */
const waiting = [];
/** The text that was sent to be read last; the text that was read last, and the state after that. */
let sent;
let known = {};

/** The slider that was moved last, and when. */
let last = {};

/** Writes the value of a slider into the text. */
async function set(variable, value) {
  // Places are those of a text that was read. Another slider or a key may have changed the text since then.
  if (known.text !== scene.text) await read();
  const { current, problem } = known.state;
  if (problem) throw new Error("The text has an error: mend it first.");
  const { sliders } = await json(`/api/runs/${current}`);
  if (known.text !== scene.text) return set(variable, value);
  const place = sliders.find((slider) => slider.variable === variable)?.place;
  if (!place) throw new Error(`There is no slider of \`${variable}\` any more.`);
  if (place.file !== path()) throw new Error(`\`${variable}\` stands in ${place.file}: change it there.`);
  const before = scene.text.split("\n").slice(0, place.line - 1).reduce((sum, line) => sum + line.length + 1, 0);
  const line = scene.text.slice(before).split("\n", 1)[0];
  const start = [...line].slice(0, place.column - 1).join("").length;
  const [number] = /^[-+]?[\d._]+(?:[eE][-+]?\d+)?/.exec(line.slice(start)) ?? [];
  if (number === undefined) throw new Error(`The value of \`${variable}\` is a formula: change it in the text.`);
  const from = before + start;
  // The values that a slider passes on its way are one step.
  const begins = last.variable !== variable || performance.now() - last.time > STEP_TIME;
  last = { variable, time: performance.now() };
  if (editor) editor.change(from, from + number.length, String(value), begins);
  else scene.text = scene.text.slice(0, from) + String(value) + scene.text.slice(from + number.length);
  await read();
}

function edited(text) {
  scene.text = text;
  clearTimeout(timer);
  timer = setTimeout(read, PAUSE);
}

/** Shows another scene. */
function show(name, text, files = {}) {
  Object.assign(scene, { name, text: text.replace(/\r\n?/g, "\n"), files });
  editor?.set(scene.text);
  say("");
  read();
}

function say(text) {
  said.textContent = text;
}

async function openExample(name) {
  const { text, files } = await shelf.load(name);
  show(name, text, files);
}

async function openLinked() {
  const asked = await linked();
  if (asked?.gallery) await openExample(asked.gallery);
  else if (asked) show(asked.name, asked.text);
  else await openExample(FIRST);
}

async function begin() {
  try {
    await openLinked();
  } catch (error) {
    await openExample(FIRST);
    say(error.message);
  }
}

async function copyLink() {
  const link = await linkOf(scene);
  history.replaceState(null, "", new URL(link).hash);
  const others = Object.keys(scene.files).length ? " The other files of the scene are not in it." : "";
  try {
    await navigator.clipboard.writeText(link);
    say(`The link is copied. It holds the scene, and nothing has left this browser.${others}`);
  } catch {
    say(`The address of this page is the link now: copy it.${others}`);
  }
}

async function takeScripts() {
  const { run } = open;
  if (!run?.description.settled) return say("The scripts are there as soon as the run is finished.");
  const { scriptsOf } = await import("./zip.js");
  const [name, { views }] = [scene.name, run.description];
  scripts.disabled = true;
  try {
    const zip = await scriptsOf({ id: run.id, frames: run.frames, views }, (part) => say(`The scripts are being made: ${Math.round(100 * part)} %`));
    save(zip, `${name}.zip`);
    say(`${name}.zip is saved. POV-Ray renders its scripts: povray animation.ini`);
  } catch (error) {
    say(error.message);
  }
  scripts.disabled = false;
}

async function takeFiles(list) {
  const files = await Promise.all(Array.from(list, async (file) => [file.name, new Uint8Array(await file.arrayBuffer())]));
  for (const [name, bytes] of files) {
    const stem = /^([\w-]+)\.toml$/.exec(name)?.[1];
    if (stem && files.filter(([other]) => other.endsWith(".toml")).length === 1) Object.assign(scene, { name: stem, text: new TextDecoder().decode(bytes) });
    else scene.files[name] = bytes;
  }
  editor?.set(scene.text);
  const others = Object.keys(scene.files);
  say(others.length ? `Files beside the scene: ${others.join(", ")}` : "");
  read();
}

/** The parts of the page that an address may choose, and their elements. The picture is always there. */
const PARTS = { text: "#editor", player: "#controls", plots: "#plots", values: "#panel", title: "header" };

/** Hides the parts of the page that the address does not name, if it names any: `?show=player,values`. For pages that show this one in a frame. */
function showParts() {
  const shown = new URLSearchParams(location.search).get("show")?.split(",");
  if (!shown) return;
  for (const [name, selector] of Object.entries(PARTS)) document.querySelector(selector).hidden = !shown.includes(name);
  document.querySelector("footer").hidden = !shown.includes("player") && !shown.includes("plots");
}

async function loadEditor() {
  const { makeEditor } = await import("./editor.js");
  editor = makeEditor(field, scene.text, edited);
  window.jabuka.editor = editor;
  mark();
}

let entries = [];
function mark() {
  editor?.mark(entries, path());
}

document.querySelector("main").prepend(pane);
document.body.append(shelf.dialog);
showParts();
onRead((state) => {
  ({ diagnostics: entries } = state);
  known = { text: sent, state };
  mark();
  waiting.splice(0).forEach((resolve) => resolve());
});
onSet(set);
window.addEventListener("hashchange", () => begin());
window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  if (!event.dataTransfer.files.length) return;
  event.preventDefault();
  takeFiles(event.dataTransfer.files);
});
begin().then(() => window.jabuka.whenDrawn(() => element("nothing").hidden || element("problem").hidden === false)).then(() => pane.hidden || loadEditor());
if (location.protocol.startsWith("http")) navigator.serviceWorker?.register("service.js");
