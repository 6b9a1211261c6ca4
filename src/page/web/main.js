// Starts the page, and updates the display whenever the server announces a new state.

import { listen } from "./controls.js";
import "./hook.js";
import { element, open } from "./parts.js";
import { tick } from "./picture/picture.js";
import { changed, sayProblem } from "./run/runs.js";
import { CAN_COMPUTE, CAN_RENDER, REFUSED, follow } from "./source.js";
import { listenToText, takeState } from "./text/scene_text.js";

function begin() {
  const nothing = element("nothing");
  nothing.hidden = false;
  if (REFUSED) {
    nothing.textContent = REFUSED;
    return;
  }
  element("render").hidden = !CAN_RENDER;
  for (const part of document.querySelectorAll("[data-computed]")) part.hidden = !CAN_COMPUTE;
  nothing.textContent = "…";
  listen();
  listenToText();
  // If several states arrive while one is being handled, only the newest is handled next.
  let newest, busy;
  const takeIn = async () => {
    busy = true;
    while (newest) {
      const state = newest;
      newest = undefined;
      // If a run has been replaced meanwhile, the next state of the server names the new one.
      await changed(state).catch((error) => error.status === 404 || console.error(error));
    }
    busy = false;
  };
  const lost = () => {
    open.gone = true;
    sayProblem();
  };
  follow((state) => {
    takeState(state);
    newest = state;
    if (!busy) takeIn();
  }, lost);
  requestAnimationFrame(tick);
}

begin();
