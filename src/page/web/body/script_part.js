// What the script of a frame says about the chosen body.

import { element, open, panel, player } from "../parts.js";
import { unpacked } from "../run/packed_files.js";
import { CAN_COMPUTE, binary } from "../source.js";

/** The frame, the run and the body whose part of the script is shown or being fetched. */
let shown = {};

/** Returns the statement of a script that ends in the comment with this name, or nothing. */
export function statement(script, name) {
  const mark = `} // ${name}`;
  const line = script.split("\n").find((line) => line.endsWith(mark));
  if (line === undefined) return undefined;
  const end = script.indexOf(`${line}\n`) + line.length;
  // It begins at the brace that belongs to the last one.
  let at = end - mark.length;
  for (let depth = 1; depth && at > 0;) {
    at--;
    if (script[at] === "}") depth++;
    if (script[at] === "{") depth--;
  }
  return script.slice(script.lastIndexOf("\n", at) + 1, end);
}

async function scriptOf(run, frame, view) {
  const bytes = new Uint8Array(await binary(`/api/runs/${run.id}/scripts`, { from: frame, to: frame + 1, view }));
  const [, script] = [...unpacked(bytes)].find(([name]) => /^frame_\d+\.pov$/.test(name)) ?? [];
  return new TextDecoder().decode(script);
}

/** Shows the part of the script for the present frame, if the user has opened it. */
export async function showScriptPart() {
  const { run, view } = open;
  const { body } = panel;
  const part = element("script-part");
  part.hidden = !CAN_COMPUTE || body === undefined;
  if (part.hidden || !part.open || player.playing || !run) return;
  const { frame } = player;
  if (shown.run === run && shown.frame === frame && shown.body === body && shown.view === view) return;
  const wanted = { run, frame, body, view };
  shown = wanted;
  const { name } = run.description.bodies[body];
  const say = (text) => shown === wanted && (element("script-text").textContent = text);
  try {
    if (!run.progress?.settled) throw new Error("The script is there as soon as the run is finished.");
    say(statement(await scriptOf(run, frame, view), name) ?? "The script of this frame does not draw the body.");
  } catch (error) {
    say(error.message);
    // It is fetched again when the run is finished.
    if (shown === wanted) shown = {};
  }
}
