// Opens and closes runs: those that the server announces, and those with the methods that the viewer has chosen.

import { short } from "../math.js";
import { Painter } from "../picture/painter.js";
import { drawn, element, open, panel, player, plots, redraw } from "../parts.js";
import { Run } from "./run.js";
import { showSliders } from "../text/sliders.js";
import { LOST, startVariant } from "../source.js";

/** Handles a new state of the server: the id of the scene's current run, the progress of all runs, and errors. */
export async function changed(state) {
  open.state = state;
  open.gone = false;
  sayProblem();
  for (const run of [open.run, open.other]) {
    const progress = run && state.runs[run.id];
    // The positions of a run's cameras are known once the run is finished.
    if (progress && (await run.progressed(progress)) && run === open.run) paint(run);
  }
  await refresh();
  // A run that broke down before it was opened reports its error only now.
  sayProblem();
  redraw();
}

/** Opens the runs that should be shown, if they differ from the open ones. */
export async function refresh() {
  const serial = ++open.serial;
  const { state } = open;
  if (!state?.current) return;
  if (open.scene !== state.current) {
    // The scene has changed. The chosen methods are requested again for the new scene.
    open.scene = state.current;
    open.wanted = {};
  }
  const [own, other] = [method("integrator", "step"), method("other-integrator", "other-step")];
  const first = await wanted("first", own, state.current);
  if (serial !== open.serial) return;
  if (first && first !== open.run?.id) await show(first, serial);
  if (serial !== open.serial) return;
  if (!other.integrator) delete open.wanted.second;
  const second = other.integrator ? await wanted("second", other, null) : null;
  if (serial !== open.serial) return;
  const problems = [open.wanted.first?.problem, open.wanted.second?.problem].filter(Boolean);
  element("method-problem").textContent = problems.join("\n\n");
  element("method-problem").hidden = !problems.length;
  if (second !== (open.other?.id ?? null)) await compare(second, serial);
  if (open.run) plots.take([open.run, ...(open.other ? [open.other] : [])], panel.body);
}

/** Returns the chosen method and timestep. Empty values stand for those of the scene. */
function method(integrator, step) {
  return { integrator: element(integrator).value, step: element(step).value.trim() };
}

/** Returns the id of the run with a method. The server starts the run if necessary. Returns `usual` if the run cannot be started. */
async function wanted(which, { integrator, step }, usual) {
  if (usual && !integrator && !step) {
    delete open.wanted[which];
    return usual;
  }
  const { state } = open;
  const key = `${integrator} ${step}`;
  // A failed method is tried again when the scene has changed. A run that the server has removed is started again.
  const scene = JSON.stringify([state.current, state.problem]);
  const known = open.wanted[which];
  if (known?.key === key && (known.problem ? known.scene === scene : state.runs[known.id])) return known.id;
  try {
    const progress = await startVariant({ integrator, step });
    open.wanted[which] = { key, id: progress.id };
    state.runs[progress.id] ??= progress;
    return progress.id;
  } catch (error) {
    open.wanted[which] = { key, id: usual, problem: error.message, scene };
    return usual;
  }
}

async function opened(id) {
  const { scene } = open;
  const run = await Run.open(id);
  run.scene = scene;
  const progress = open.state.runs[id];
  if (progress) await run.progressed(progress);
  return run;
}

/** Shows a run, at the same time as the previous one. */
async function show(id, serial) {
  let run;
  try {
    const opening = opened(id);
    // Starting the graphics processor takes as long as fetching a run, so both happen at the same time.
    if (!startPainter()) return;
    run = await opening;
  } catch (error) {
    // The run has been replaced meanwhile. The next state of the server names the new one.
    if (error.status === 404) return;
    throw error;
  }
  if (serial !== open.serial) return run.close();
  // The new run is shown only when its frame at this time has been fetched.
  const frame = run.frameAt(player.time);
  run.changed = () => redraw();
  await run.ready(Math.min(frame, Math.max(0, (run.progress?.recorded ?? 1) - 1)), open.view);
  if (serial !== open.serial) return run.close();
  open.run?.close();
  open.run = run;
  // A comparison belongs to the scene that it was made for.
  if (open.other && open.other.scene !== run.scene) leave();
  if (open.view > run.description.views.length) open.view = 0;
  player.take(run);
  paint(run);
  panel.take(run);
  plots.take([run, ...(open.other ? [open.other] : [])], panel.body);
  describe(run);
  showSliders(run);
  if (open.other) await compare(open.other.id, serial);
}

/** Makes the painter draw a run. */
function paint(run) {
  open.painter.take(run);
  open.strobes = null;
  if (open.other?.bodies === run.bodies) open.painter.put("other", run.description.bodies.map((_, body) => ({ body, pose: body })));
}

/** Ends the comparison with another run. */
function leave() {
  open.other?.close();
  open.other = null;
  open.painter.release("other");
  element("comparison").textContent = "";
}

async function compare(id, serial) {
  if (id === null) return leave();
  const run = open.other?.id === id ? open.other : await opened(id);
  if (serial !== open.serial && run !== open.other) return run.close();
  if (open.other !== run) open.other?.close();
  open.other = run;
  run.changed = () => redraw();
  paint(open.run);
}

/** Makes the painter when it is first needed. Returns true if WebGL2 is available. */
function startPainter() {
  if (open.painter !== undefined) return open.painter !== null;
  try {
    open.painter = new Painter(element("picture"));
  } catch (error) {
    open.painter = null;
    element("nothing").textContent = error.message;
    element("nothing").hidden = false;
  }
  return open.painter !== null;
}

/** Shows the values that are constant during a run. */
function describe(run) {
  const { description } = run;
  const title = description.title ?? description.name;
  document.title = `${title} – jabuka`;
  element("title").textContent = title;
  element("time").max = run.frames - 1;
  for (const [id, none] of [["integrator", `scene: ${open.state.integrator}`], ["other-integrator", "nothing"]]) {
    const select = element(id);
    const value = select.value;
    const options = description.methods.map(({ name, summary }) => Object.assign(new Option(name), { title: summary }));
    select.replaceChildren(new Option(none, ""), ...options);
    select.value = value;
  }
  element("step").placeholder = short(description.step);
  element("other-step").placeholder = short(description.step);
  const view = element("view");
  view.replaceChildren(new Option("main camera", 0), ...description.views.map((name, i) => new Option(name, i + 1)));
  view.value = open.view;
  view.hidden = description.views.length === 0;
  element("nothing").hidden = true;
}

/** Opens or folds the warnings. */
export function foldWarnings() {
  const fold = element("warnings");
  fold.setAttribute("aria-expanded", String(fold.getAttribute("aria-expanded") === "false"));
  sayProblem();
}

export function sayProblem() {
  const { state, gone } = open;
  const problem = element("problem");
  const run = open.run && state?.runs[open.run.id];
  const wrong = gone ? LOST : state?.problem ?? run?.problem;
  const mild = [state?.warnings, run?.warnings].filter(Boolean).join("");
  problem.textContent = wrong || mild;
  problem.classList.toggle("mild", !wrong);
  // Errors are always open. Warnings are folded to a line until the user wants to read them.
  const fold = element("warnings");
  fold.hidden = Boolean(wrong) || !mild;
  problem.hidden = wrong ? false : !mild || fold.getAttribute("aria-expanded") === "false";
  const heads = mild.match(/^warning.*$/gm) ?? [];
  const [first] = heads.map((line) => line.replace(/^warning(\[[^\]]*\])?: /, ""));
  fold.textContent = heads.length > 1 ? `${heads.length} warnings: ${first}, …` : `Warning: ${first}`;
  if (state && !state.current && wrong) {
    element("nothing").textContent = "The scene has errors. It is shown as soon as they are mended.";
    element("nothing").hidden = false;
  }
}
