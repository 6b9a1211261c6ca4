// Prints the licences of the packages that are bundled into the extension.

import { readFileSync, readdirSync } from "node:fs";

const { packages } = JSON.parse(readFileSync("package-lock.json", "utf8"));
for (const [path, { dev, license, version }] of Object.entries(packages)) {
  if (!path || dev) continue;
  const file = readdirSync(path).find((name) => /^licen[cs]e/i.test(name));
  console.log(`${path.replace(/.*node_modules\//, "")} ${version}, ${license}\n\n${file ? readFileSync(`${path}/${file}`, "utf8").trim() : ""}\n`);
}
