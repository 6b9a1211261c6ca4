// The playground: the page of the preview, with an editor, a shelf of scenes, and links.

import { make } from "../../src/page/web/elements.js";
import "../../src/page/web/main.js";
import { element } from "../../src/page/web/parts.js";
import { load, say, sceneText } from "../../src/page/web/text/scene_text.js";
import { keep, kept } from "./kept_text.js";
import { linkOf, linked } from "./link.js";
import { makeShelf } from "./shelf.js";
import { setScene } from "./source.js";
import { makeTutorial } from "./tutorial.js";

/** The scene that a first visit shows. */
const FIRST = "newtons_cradle";

/** The bytes of the files beside the scene, by path. */
let others = {};
/** The text as it was opened. */
let opened;

const button = (label, title, deed) => make("button", { type: "button", textContent: label, title, onclick: deed });
const shelf = makeShelf(async (name) => {
  await openExample(name);
  history.replaceState(null, "", `#gallery=${name}`);
});

const tutorial = makeTutorial(show);

/** The name of the scene: that of its file without the ending. */
const name = () => sceneText().file.replace(/\.toml$/, "");

/** Shows another scene. */
function show(name, text, files = {}) {
  others = files;
  opened = text.replace(/\r\n?/g, "\n");
  const path = `${name}.toml`;
  setScene(path, { ...files, [path]: opened });
  return load();
}

async function openExample(name) {
  const { text, files } = await shelf.load(name);
  await show(name, text, files);
}

/** Shows the text that was edited at this address before the page was loaded again. */
async function openKept() {
  const own = kept();
  const before = opened;
  if (!own || own.text === before) return;
  await show(own.name, own.text, others);
  opened = before;
  say("This is your text from before. ", button("Start anew", "Show the scene as it was opened", () => show(own.name, before, others)));
}

async function openLinked() {
  const asked = await linked();
  if (asked?.tutorial) await tutorial.begin();
  else if (asked?.gallery) await openExample(asked.gallery);
  else if (asked) await show(asked.name, asked.text);
  else await openExample(FIRST);
  if (!asked?.tutorial) await openKept();
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
  const link = await linkOf({ name: name(), text: sceneText().text });
  history.replaceState(null, "", new URL(link).hash);
  const without = Object.keys(others).length ? " The other files of the scene are not in it." : "";
  try {
    await navigator.clipboard.writeText(link);
    say(`The link is copied. It holds the scene, and nothing has left this browser.${without}`);
  } catch {
    say(`The address of this page is the link now: copy it.${without}`);
  }
}

async function takeFiles(list) {
  const files = await Promise.all(Array.from(list, async (file) => [file.name, new Uint8Array(await file.arrayBuffer())]));
  const scenes = files.filter(([file]) => /^[\w-]+\.toml$/.test(file));
  // Several scenes include each other, so they lie beside the one that is shown.
  const [scene] = scenes.length === 1 ? scenes : [];
  const beside = { ...others, ...Object.fromEntries(files.filter((file) => file !== scene)) };
  const text = scene ? new TextDecoder().decode(scene[1]) : sceneText().text;
  await show(scene ? scene[0].replace(/\.toml$/, "") : name(), text, beside);
  const names = Object.keys(beside);
  say(names.length ? `Files beside the scene: ${names.join(", ")}` : "");
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

element("tools").append(button("Examples", "Choose a scene", () => shelf.show()), button("Copy link", "Copy a link that holds this scene", copyLink), button("Tutorial", "Learn to write a scene, step by step", () => tutorial.begin()));
element("tools").after(tutorial.pane);
document.body.append(shelf.dialog);
showParts();
window.addEventListener("pagehide", () => sceneText().file && keep({ name: name(), text: sceneText().text }));
window.addEventListener("hashchange", () => begin());
window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  if (!event.dataTransfer.files.length) return;
  event.preventDefault();
  takeFiles(event.dataTransfer.files);
});
begin();
if (location.protocol.startsWith("http")) navigator.serviceWorker?.register("service.js");
