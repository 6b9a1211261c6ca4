// The tutorial beside the text: what to try, step by step, and a check that it was done.

import { make } from "../../src/page/web/elements.js";
import { open, panel } from "../../src/page/web/parts.js";
import { sceneText, setText } from "../../src/page/web/text/scene_text.js";
import { STEPS } from "./tutorial_steps.js";

/** The time between two checks of the present step, ms. */
const INTERVAL = 200;

/** Returns what the checks of the steps look at. */
function seen(memory) {
  const { jabuka } = window;
  const { run } = open;
  const frames = run?.description.settled ? run.frames : 0;
  return {
    memory,
    frame: jabuka.frame,
    text: sceneText().text,
    problem: jabuka.problem,
    isCompared: Boolean(open.other),
    chosen: run?.description.bodies[panel.body]?.name,
    sliders: run?.description.sliders ?? [],
    hash: location.hash,
    /** The locations of a body in all frames, m. Empty until all are there. */
    path(body) {
      const poses = Array.from({ length: frames }, (_, frame) => jabuka.pose(body, frame));
      return poses.every(Boolean) ? poses.map(({ location }) => location) : [];
    },
  };
}

/** Makes the part of the page that shows the tutorial. `show` receives the name and the text of a scene, `ended` is called when it is closed. */
export function makeTutorial(show) {
  const heading = make("h2");
  const said = make("div");
  const done = make("p", { className: "done" });
  done.setAttribute("role", "status");
  const button = (label, deed) => make("button", { type: "button", textContent: label, onclick: deed });
  const [back, next] = [button("Back", () => go(at - 1)), button("Next", () => go(at + 1))];
  const pane = make("section", { id: "tutorial", hidden: true }, heading, said, done, make("p", {}, back, " ", next, " ", button("Close", close)));
  pane.setAttribute("aria-label", "Tutorial");
  let at = 0;
  let timer;
  let memory;

  function code(text) {
    return make("div", { className: "code" }, make("pre", { textContent: text }));
  }

  function go(number) {
    at = Math.max(0, Math.min(STEPS.length - 1, number));
    const step = STEPS[at];
    memory = {};
    heading.textContent = `Step ${at + 1} of ${STEPS.length}: ${step.title}`;
    said.replaceChildren(...step.says.map((part) => (part.code ? code(part.code) : make("p", { textContent: part }))));
    // The text of the steps before may have been changed or skipped, so a step brings its own where it needs one.
    if (step.mend) said.append(button("Do it for me", () => setText(step.mend(sceneText().text))));
    done.textContent = "";
    back.disabled = at === 0;
    next.hidden = at === STEPS.length - 1;
    next.classList.remove("ready");
    clearInterval(timer);
    timer = setInterval(check, INTERVAL);
  }

  function check() {
    let isDone = false;
    try {
      isDone = STEPS[at].done(seen(memory));
    } catch (error) {
      // A run may be replaced while it is looked at.
      if (!(error instanceof TypeError)) throw error;
    }
    if (!isDone) return;
    clearInterval(timer);
    done.textContent = `✓ ${STEPS[at].well}`;
    next.classList.add("ready");
  }

  function close() {
    clearInterval(timer);
    pane.hidden = true;
  }

  return {
    pane,
    /** Begins the tutorial with its first scene. */
    async begin() {
      pane.hidden = false;
      await show("first", STEPS[0].scene);
      go(0);
    },
  };
}
