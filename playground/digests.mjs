// Prints what the module makes of scenes as lines of the one list that holds for all machines: node digests.mjs MODULE.wasm SCENE.toml …
//
// tests/scenes/digests.rs makes the list, and says what a line means.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync } from "node:fs";
import { basename, dirname, join } from "node:path";

import { unpacked } from "../src/page/web/run/packed_files.js";
import { FONTS } from "./web/fonts.js";
import { Jabuka } from "./web/module.js";

/** The number of frames whose scripts are made together. */
const TOGETHER = 100;

const [path, ...scenes] = process.argv.slice(2);
const module = new WebAssembly.Module(readFileSync(path));
const fonts = FONTS.map((name) => readFileSync(new URL(`../templates/assets/${name}`, import.meta.url)));

/** Returns the bytes of all files below a folder, by path. */
function filesBelow(folder, before = "") {
  const files = {};
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) Object.assign(files, filesBelow(path, `${before}${entry.name}/`));
    else files[before + entry.name] = readFileSync(path);
  }
  return files;
}

const digest = (contents) => createHash("sha256").update(contents).digest("hex");

/** Returns the digest of all scripts of a run: that of their names and digests, in the order of names. */
function scriptsDigest(jabuka, id, frames) {
  const digests = new Map();
  const { views } = jabuka.json({ path: `/api/runs/${id}` });
  for (let view = 0; view <= views.length; view++) {
    for (let from = 0; from < frames; from += TOGETHER) {
      const packed = jabuka.ask({ path: `/api/runs/${id}/scripts`, frames: { from, to: from + TOGETHER, view } });
      for (const [file, contents] of unpacked(packed)) digests.set(`${view ? `${views[view - 1]}/` : ""}${file}`, digest(contents));
    }
  }
  const names = [...digests.keys()].sort();
  return digest(names.map((name) => `${digests.get(name)}  ${name}\n`).join(""));
}

for (const scene of scenes) {
  const begun = performance.now();
  const jabuka = await Jabuka.start(module, fonts);
  jabuka.put(filesBelow(dirname(scene)));
  const { current, problem } = jabuka.read(basename(scene));
  if (problem) throw new Error(problem);
  while (jabuka.advance(1000));
  const simulated = performance.now();
  const progress = jabuka.json({ path: "/api/state" }).runs[current];
  if (progress.problem) throw new Error(progress.problem);
  const name = basename(scene, ".toml");
  console.log(`${name} scripts ${scriptsDigest(jabuka, current, progress.frames)}`);
  for (const kind of ["table", "model"]) console.log(`${name} ${kind} ${digest(jabuka.ask({ path: `/api/runs/${current}/${kind}` }))}`);
  const seconds = (milliseconds) => (milliseconds / 1000).toFixed(2);
  console.error(`${name}: simulated in ${seconds(simulated - begun)} s, written in ${seconds(performance.now() - simulated)} s`);
}
