// Makes the bundles of the libraries, and the text of their licences. `build` installs the packages and calls it.

import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const bundles = join(here, "../web/libraries");
const modules = join(process.env.JABUKA_MODULES, "node_modules");
const { build } = createRequire(`${modules}/`)("esbuild");

/** The entry files. Each becomes a bundle with the same name. */
const ENTRIES = ["codemirror.js", "video.js", "zip.js"];

/** Returns the licences of the packages that an import of the entry files reaches. */
function licences(inputs) {
  const packages = inputs.map((input) => /node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1]);
  const texts = [...new Set(packages)].filter(Boolean).sort().map((name) => {
    const folder = join(modules, name);
    const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const files = readdirSync(folder).filter((file) => /^licen[cs]e/i.test(file)).sort();
    return `${name} ${version}: ${license}\n\n${files.map((file) => readFileSync(join(folder, file), "utf8").trim()).join("\n\n")}\n`;
  });
  return texts.join(`\n${"-".repeat(72)}\n`);
}

const options = { bundle: true, minify: true, format: "esm", target: "es2022", legalComments: "none", charset: "utf8", logLevel: "warning", absWorkingDir: here, nodePaths: [modules] };
const { outputFiles, metafile } = await build({ ...options, entryPoints: ENTRIES, outdir: bundles, write: false, metafile: true });
const made = new Map(outputFiles.map(({ path, contents }) => [path, Buffer.from(contents)]));
made.set(join(bundles, "licences.txt"), Buffer.from(licences(Object.keys(metafile.inputs))));

if (process.argv.includes("--check")) {
  const others = [...made].filter(([path, contents]) => !contents.equals(readFileSync(path)));
  for (const [path] of others) console.error(`${path} is not what src/page/libraries/build makes`);
  process.exit(others.length ? 1 : 0);
}
mkdirSync(bundles, { recursive: true });
for (const [path, contents] of made) writeFileSync(path, contents);
