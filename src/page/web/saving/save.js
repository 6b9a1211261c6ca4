// The menu of what a viewer can take along: a picture, a film, a model, a table, a page, the scripts.

import { download } from "./download.js";
import { CAN_ENCODE, FORMATS, filmFile, filmRate, usualFormat } from "./film.js";
import { short } from "../math.js";
import { element, open, player, redraw } from "../parts.js";
import { scriptsZip } from "./scripts_zip.js";
import { pictureFile, shownSize } from "./snapshots.js";
import { CAN_RENDER, binary } from "../source.js";

const PICTURE_SIZES = [[1280, 720], [1920, 1080], [3840, 2160]];
const FILM_SIZES = [[640, 360], [1280, 720], [1920, 1080]];

const NO_ENCODER = "This browser has no WebCodecs, which encode films. Some browsers have them only on pages of https.";

/** Ends what is being made. Undefined if nothing is. */
let working;

function say(text) {
  element("save-said").textContent = text;
}

/** Fills a list of sizes: that of the scene first. The chosen one stays chosen. */
function offer(select, sizes, scene, more = []) {
  const { value } = select;
  const option = ([width, height]) => {
    const asInTheScene = width === scene[0] && height === scene[1] ? ", as in the scene" : "";
    return new Option(`${width} × ${height}${asInTheScene}`, `${width} ${height}`);
  };
  const others = sizes.filter(([width, height]) => width !== scene[0] || height !== scene[1]);
  select.replaceChildren(...more, ...[scene, ...others].map(option));
  if ([...select.options].some((one) => one.value === value)) select.value = value;
}

/** Returns the chosen size, in pixels. */
function sizeOf(select) {
  const [width, height] = select.value.split(" ").map(Number);
  return { width, height };
}

/** Returns the chosen frames of the film. */
function chosenFrames() {
  const [from, to] = ["film-from", "film-to"].map((id) => element(id).valueAsNumber);
  if (!(Number.isInteger(from) && Number.isInteger(to) && from >= 0 && to >= from && to <= player.end)) throw new Error(`The film can have the frames 0 to ${player.end}.`);
  return { from, to };
}

/** What each button makes: the file's name, and its contents. It gets the shown run, and `tell` and `signal`. */
const MAKERS = {
  "save-picture": async ({ description: { name } }) => {
    const select = element("picture-size");
    const { frame } = player;
    return [`${name}_${frame}.png`, await pictureFile(select.value === "shown" ? shownSize() : sizeOf(select))];
  },
  "save-film": async ({ description: { name } }, work) => {
    const format = element("film-format").value;
    return [`${name}.${format}`, await filmFile({ ...sizeOf(element("film-size")), format, ...chosenFrames() }, work)];
  },
  "save-model": async ({ id, description: { name } }, { signal }) => [`${name}.glb`, new Blob([await binary(`/api/runs/${id}/model`, {}, signal)], { type: "model/gltf-binary" })],
  "save-table": async ({ id, description: { name } }, { signal }) => [`${name}.csv`, new Blob([await binary(`/api/runs/${id}/table`, {}, signal)], { type: "text/csv" })],
  "save-page": async ({ id, description: { name } }, { signal }) => [`${name}.html`, new Blob([await binary(`/api/runs/${id}/page`, {}, signal)], { type: "text/html" })],
  "save-scripts": async (run, work) => [`${run.description.name}.zip`, await scriptsZip(run, work)],
};

async function make(id) {
  const { run } = open;
  if (id !== "save-picture" && !run.progress?.settled) return say("The run is not finished yet: try again when it is.");
  working = new AbortController();
  const { signal } = working;
  show(true);
  say("The file is being made …");
  try {
    const [name, blob] = await MAKERS[id](run, { tell: (part) => (element("save-progress").value = part), signal });
    signal.throwIfAborted();
    download(blob, name);
    say(`${name} is saved: ${sizeInWords(blob.size)}.`);
  } catch (error) {
    if (signal.aborted) say("Nothing is saved.");
    else say(open.run === run ? error.message : "The scene has changed meanwhile: nothing is saved.");
  }
  working = undefined;
  show(false);
  element(id).focus();
}

const sizeInWords = (bytes) => (bytes < 1e6 ? `${short(bytes / 1e3, 3)} kB` : `${short(bytes / 1e6, 3)} MB`);

/** Shows whether something is being made. */
function show(busy) {
  for (const id of Object.keys(MAKERS)) element(id).disabled = busy || (id === "save-film" && !CAN_ENCODE);
  element("save-progress").removeAttribute("value");
  element("save-work").hidden = !busy;
  if (busy) element("save-stop").focus();
}

function showMenu() {
  const { run } = open;
  if (!run) return;
  player.pause();
  redraw();
  const { size } = run.description;
  offer(element("picture-size"), PICTURE_SIZES, size, [new Option("as shown", "shown")]);
  // Codecs take only even sizes.
  offer(element("film-size"), FILM_SIZES, size.map((pixels) => 2 * Math.ceil(pixels / 2)));
  element("film-from").value = 0;
  element("film-to").value = player.end;
  for (const id of ["film-from", "film-to"]) element(id).max = player.end;
  element("film-note").textContent = CAN_ENCODE ? `${short(filmRate(run))} frames a second` : NO_ENCODER;
  say("");
  // After the menu was closed, a piece of work may need a moment to end.
  show(Boolean(working));
  element("save-dialog").showModal();
}

/** Makes the menu work. */
export function prepareSaving() {
  element("save").onclick = showMenu;
  // The playground does not hold the parts of a page in one file.
  element("save-page").hidden = !CAN_RENDER;
  for (const id of Object.keys(MAKERS)) element(id).onclick = () => make(id);
  element("save-stop").onclick = element("save-dialog").onclose = () => working?.abort();
  const format = element("film-format");
  format.replaceChildren(...Object.entries(FORMATS).map(([value, text]) => new Option(text, value)));
  if (CAN_ENCODE) usualFormat().then((usual) => (format.value = usual));
}
