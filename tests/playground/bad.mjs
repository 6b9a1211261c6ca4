// Reads scenes one after another in one module, and prints what it says of each as JSON: node bad.mjs MODULE.wasm SCENE.toml …

import { readFileSync } from "node:fs";
import { basename } from "node:path";

import { FONTS } from "../../playground/web/fonts.js";
import { Jabuka } from "../../playground/web/module.js";

const [path, ...scenes] = process.argv.slice(2);
const fonts = FONTS.map((name) => readFileSync(new URL(`../../templates/assets/${name}`, import.meta.url)));
const jabuka = await Jabuka.start(new WebAssembly.Module(readFileSync(path)), fonts, () => {});
const said = scenes.map((scene) => {
  const name = basename(scene);
  jabuka.put({ [name]: readFileSync(scene) });
  const { problem, diagnostics } = jabuka.read(name);
  return [name, { problem, diagnostics }];
});
console.log(JSON.stringify(Object.fromEntries(said)));
