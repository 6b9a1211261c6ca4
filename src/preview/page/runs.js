// Which runs are open: those that the server announces, and those by the methods that are chosen.

import { short } from "./math.js";
import { Painter } from "./painter.js";
import { drawn, element, open, panel, player, plots, redraw } from "./parts.js";
import { Run } from "./run.js";
import { post } from "./server.js";

/** Takes in a state: which run is the scene's now, how far runs are, what is wrong. */
export async function changed(state) {
  open.state = state;
  open.gone = false;
  sayProblem();
  for (const run of [open.run, open.other]) {
    const progress = run && state.runs[run.id];
    // When a run is finished, it is known where its camera stands.
    if (progress && (await run.progressed(progress)) && run === open.run) paint(run);
  }
  await refresh();
  // A run that had diverged before it was opened says so only now.
  sayProblem();
  redraw();
}

/** Opens the runs that should be shown, if they are others than before. */
export async function refresh() {
  const serial = ++open.serial;
  const { state } = open;
  if (!state?.current) return;
  if (open.scene !== state.current) {
    // Another scene: what was chosen for the old one is asked for again, of the new one.
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

/** The method that is chosen; an empty one is the scene's. */
function method(integrator, step) {
  return { integrator: element(integrator).value, step: element(step).value.trim() };
}

/** The number of the run by a method, which the server begins if need be; `usual` where there can be none. */
async function wanted(which, { integrator, step }, usual) {
  if (usual && !integrator && !step) {
    delete open.wanted[which];
    return usual;
  }
  const { state } = open;
  const key = `${integrator} ${step}`;
  // What has failed may be possible with another scene; what others have driven out is begun again.
  const scene = JSON.stringify([state.current, state.problem]);
  const known = open.wanted[which];
  if (known?.key === key && (known.problem ? known.scene === scene : state.runs[known.id])) return known.id;
  try {
    const progress = await (await post("/api/variants", { integrator, step })).json();
    open.wanted[which] = { key, id: progress.id };
    state.runs[progress.id] ??= progress;
    return progress.id;
  } catch (error) {
    open.wanted[which] = { key, id: usual, problem: error.message, scene };
    return usual;
  }
}

async function opened(id) {
  const run = await Run.open(id);
  const progress = open.state.runs[id];
  if (progress) await run.progressed(progress);
  return run;
}

/** Shows a run, at the same time as the one before. */
async function show(id, serial) {
  let run;
  try {
    const opening = opened(id);
    // To start the graphics processor takes as long as to fetch a run, so both are done at once.
    if (!startPainter()) return;
    run = await opening;
  } catch (error) {
    // It has been replaced meanwhile; the next state tells by what.
    if (error.status === 404) return;
    throw error;
  }
  if (serial !== open.serial) return run.close();
  // The new run is not shown before there is something of it at this time.
  const frame = run.frameAt(player.time);
  run.changed = () => redraw();
  await run.ready(Math.min(frame, Math.max(0, (run.progress?.recorded ?? 1) - 1)), open.view);
  if (serial !== open.serial) return run.close();
  open.run?.close();
  open.run = run;
  if (open.view > run.description.views.length) open.view = 0;
  player.take(run);
  paint(run);
  panel.take(run);
  describe(run);
  if (open.other) await compare(open.other.id, serial);
}

/** Makes the picture that of a run. */
function paint(run) {
  open.painter.take(run);
  open.strobes = null;
  if (open.other?.bodies === run.bodies) open.painter.put("other", run.description.bodies.map((_, body) => ({ body, pose: body })));
}

async function compare(id, serial) {
  if (id === null) {
    open.other?.close();
    open.other = null;
    open.painter.release("other");
    element("comparison").textContent = "";
    return;
  }
  const run = open.other?.id === id ? open.other : await opened(id);
  if (serial !== open.serial && run !== open.other) return run.close();
  if (open.other !== run) open.other?.close();
  open.other = run;
  run.changed = () => redraw();
  paint(open.run);
}

/** Makes what draws, at the first time; tells whether it is there. */
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

/** What stays the same while a run is shown. */
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

export function sayProblem() {
  const { state, gone } = open;
  const problem = element("problem");
  const run = open.run && state?.runs[open.run.id];
  const wrong = gone ? "The server does not answer: `jabuka preview` has ended, or the connection is lost." : state?.problem ?? run?.problem;
  const mild = [state?.warnings, run?.warnings].filter(Boolean).join("");
  problem.textContent = wrong || mild;
  problem.classList.toggle("mild", !wrong);
  problem.hidden = !(wrong || mild);
  if (state && !state.current && wrong) {
    element("nothing").textContent = "The scene has errors. It is shown as soon as they are mended.";
    element("nothing").hidden = false;
  }
}
