// The scripts of a run as a zip file.

import { unpacked } from "../run/packed_files.js";
import { binary } from "../source.js";

/** The number of frames whose scripts are made together. */
const TOGETHER = 50;

/**
 * Returns a zip file with all that `jabuka compile` writes for a run, except its manifest. Each camera besides the main one has a folder. `tell`
 * receives the part that is done, from 0 to 1. `signal` ends the work.
 */
export async function scriptsZip({ id, frames, description: { views } }, { tell, signal }) {
  const { Zip, ZipDeflate } = await import("../libraries/zip.js");
  const parts = [];
  const zip = new Zip((error, part) => {
    if (error) throw error;
    parts.push(part);
  });
  for (let view = 0; view <= views.length; view++) {
    const folder = view ? `${views[view - 1]}/` : "";
    const known = new Set();
    for (let from = 0; from < frames; from += TOGETHER) {
      const bytes = new Uint8Array(await binary(`/api/runs/${id}/scripts`, { from, to: from + TOGETHER, view }));
      signal.throwIfAborted();
      for (const [name, contents] of unpacked(bytes)) {
        if (known.has(name)) continue;
        known.add(name);
        // Equal scripts give equal files, so the time of each is a fixed one.
        const file = new ZipDeflate(folder + name, { level: 6, mtime: "1980-01-01T00:00:00" });
        zip.add(file);
        file.push(contents, true);
      }
      tell((view + Math.min(1, (from + TOGETHER) / frames)) / (views.length + 1));
    }
  }
  zip.end();
  return new Blob(parts, { type: "application/zip" });
}
