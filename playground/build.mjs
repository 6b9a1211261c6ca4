// Makes the static folder of the playground: node build.mjs MODULE.wasm

import { build } from "esbuild";
import { createHash } from "node:crypto";
import { copyFileSync, cpSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { FONTS } from "./web/fonts.js";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "..");
const page = join(root, "src/page/web");
const dist = join(here, "dist");
const [module] = process.argv.slice(2);

const POLICY =
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; img-src 'self' blob: data:; " +
  "style-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'";

/** The page's modules get their data from the worker. */
const source = {
  name: "source",
  setup: ({ onResolve }) => onResolve({ filter: /^\.\.?\/source\.js$/ }, () => ({ path: join(here, "web/source.js") })),
};

rmSync(dist, { recursive: true, force: true });
mkdirSync(join(dist, "scenes"), { recursive: true });
const common = { bundle: true, minify: true, target: "es2022", legalComments: "none", logLevel: "warning" };
await build({ ...common, entryPoints: [join(here, "web/main.js")], outdir: dist, format: "esm", splitting: true, chunkNames: "[name]-[hash]", plugins: [source] });
await build({ ...common, entryPoints: [join(here, "web/worker.js")], outdir: dist, format: "iife" });

copyFileSync(module, join(dist, "jabuka.wasm"));
for (const name of ["icon.svg"]) copyFileSync(join(page, name), join(dist, name));
for (const name of FONTS) copyFileSync(join(root, "templates/assets", name), join(dist, name));
const style = ["style.css", "playground.css"].map((name) => readFileSync(join(name === "style.css" ? page : join(here, "web"), name), "utf8"));
writeFileSync(join(dist, "style.css"), style.join(""));
const preloads = ["jabuka.wasm", ...FONTS].map((name) => `<link rel="preload" href="${name}" as="fetch" crossorigin>`).join("\n");
const html = readFileSync(join(page, "index.html"), "utf8")
  .replace(/<link rel="modulepreload"[^>]*>\n/g, "")
  .replace("<title>", `<meta http-equiv="Content-Security-Policy" content="${POLICY}">\n${preloads}\n<title>`);
writeFileSync(join(dist, "index.html"), html);

// The shelf has the topics, titles and sentences of the gallery's page.
const gallery = readFileSync(join(root, "docs/gallery.md"), "utf8");
const others = readdirSync(join(root, "scenes"), { withFileTypes: true })
  .filter((entry) => entry.isDirectory())
  .flatMap(({ name }) => readdirSync(join(root, "scenes", name)).map((file) => `${name}/${file}`));
const topics = gallery.split("\n## ").slice(1).map((part) => {
  const topic = part.slice(0, part.indexOf("\n"));
  const cards = [...part.matchAll(/\[!\[([^\]]*)\]\(gallery\/(\w+)\.jpg\)\]\([^)]*\)<br>\*\*[^*]*\*\*<br>([^|]*)\|/g)];
  const scenes = cards.map(([, title, name, about]) => {
    const text = readFileSync(join(root, "scenes", `${name}.toml`), "utf8");
    writeFileSync(join(dist, "scenes", `${name}.toml`), text);
    copyFileSync(join(root, "docs/gallery", `${name}.jpg`), join(dist, "scenes", `${name}.jpg`));
    return { name, title, about: about.trim(), files: others.filter((file) => text.includes(file)) };
  });
  return { topic, scenes };
});
for (const file of new Set(topics.flatMap(({ scenes }) => scenes.flatMap(({ files }) => files)))) {
  mkdirSync(dirname(join(dist, "scenes", file)), { recursive: true });
  copyFileSync(join(root, "scenes", file), join(dist, "scenes", file));
}
// What `jabuka new` writes comes first.
const starters = join(root, "scenes/starters");
const own = readdirSync(starters).filter((file) => file.endsWith(".toml")).map((file) => {
  const text = readFileSync(join(starters, file), "utf8");
  writeFileSync(join(dist, "scenes", file), text);
  const files = readdirSync(join(starters, "data")).map((name) => `data/${name}`).filter((path) => text.includes(path));
  const [, about, title] = /^# ([^.?]*[.?])[^]*?^title = "(.*)"$/m.exec(text);
  return { name: file.replace(".toml", ""), title, about, files, isNew: true };
});
cpSync(join(starters, "data"), join(dist, "scenes/data"), { recursive: true });
own.sort((one, other) => (other.name === "first") - (one.name === "first"));
writeFileSync(join(dist, "scenes/shelf.json"), JSON.stringify([{ topic: "A scene of your own", scenes: own }, ...topics]));

// The licences of what the page contains.
const { packages } = JSON.parse(readFileSync(join(here, "package-lock.json"), "utf8"));
const bundled = Object.entries(packages).filter(([path, { license }]) => path && license && !/esbuild|axe-core/.test(path));
const texts = bundled.map(([path, { version: number, license }]) => {
  const folder = join(here, path);
  const text = readdirSync(folder).filter((name) => /^licen[cs]e/i.test(name)).map((name) => readFileSync(join(folder, name), "utf8")).join("\n");
  return `${path.replace("node_modules/", "")} ${number}: ${license}\n\n${text}`;
});
const ofPage = readFileSync(join(page, "libraries/licences.txt"), "utf8");
writeFileSync(join(dist, "licences.txt"), [...texts, ofPage].join(`\n${"-".repeat(72)}\n`));

// The name of the cache of the browser changes with any file, so that no visitor keeps an old one.
const digest = createHash("sha256");
const names = readdirSync(dist, { recursive: true }).sort().filter((name) => statSync(join(dist, name)).isFile());
for (const name of names) digest.update(name).update(readFileSync(join(dist, name)));
const version = digest.digest("hex").slice(0, 16);
const kept = ["./", ...names.filter((name) => !/\.(jpg|txt)$/.test(name))];
const service = readFileSync(join(here, "web/service.js"), "utf8");
writeFileSync(join(dist, "service.js"), service.replace("VERSION", version).replace('["FILES"]', JSON.stringify(kept)));
