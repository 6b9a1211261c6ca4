// The shelf: all scenes of the gallery, by topic, with small pictures.

import { make } from "../../src/page/web/elements.js";

async function fetched(path) {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path}: ${response.status}`);
  return response;
}

/** Makes the dialog of the shelf. `chosen` receives the name of a scene. */
export function makeShelf(chosen) {
  const close = make("form", { method: "dialog" }, make("button", { textContent: "Close" }));
  const heading = make("h2", { id: "shelf-heading", textContent: "Examples" });
  const list = make("div", { id: "shelf-list" });
  const dialog = make("dialog", { id: "shelf" }, close, heading, list);
  dialog.setAttribute("aria-labelledby", "shelf-heading");
  let topics;
  const shelf = async () => (topics ??= (await fetched("scenes/shelf.json")).json());

  const card = ({ name, title, about, isNew }) => {
    const picture = isNew ? "" : make("img", { src: `scenes/${name}.jpg`, alt: "", loading: "lazy", width: 320, height: 180 });
    const deed = () => {
      dialog.close();
      chosen(name);
    };
    return make("button", { type: "button", className: "card", onclick: deed }, picture, make("strong", { textContent: title }), make("span", { textContent: about }));
  };

  return {
    dialog,
    async show() {
      if (!list.childElementCount) {
        for (const { topic, scenes } of await shelf()) list.append(make("h3", { textContent: topic }), make("div", { className: "cards" }, ...scenes.map(card)));
      }
      dialog.showModal();
    },
    /** Fetches the text of a scene, and its other files. */
    async load(name) {
      const found = (await shelf()).flatMap(({ scenes }) => scenes).find((scene) => scene.name === name);
      if (!found) throw new Error(`There is no example \`${name}\`.`);
      const text = await (await fetched(`scenes/${name}.toml`)).text();
      const load = async (path) => [path, new Uint8Array(await (await fetched(`scenes/${path}`)).arrayBuffer())];
      return { text, files: Object.fromEntries(await Promise.all(found.files.map(load))) };
    },
  };
}
