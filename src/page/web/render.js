// Renders the current frame with POV-Ray, and shows the image beside the picture.

import { element, open, player, redraw } from "./parts.js";
import { renderFrame } from "./source.js";

export async function renderThis() {
  const { run } = open;
  if (!run || open.rendering) return;
  player.pause();
  redraw();
  const frame = player.frame;
  const [button, image, said, problem] = ["render", "rendered", "render-status", "render-problem"].map(element);
  element("image").hidden = false;
  open.rendering = true;
  button.disabled = true;
  problem.hidden = true;
  try {
    for (const fine of [false, true]) {
      said.textContent = `frame ${frame}: ${fine ? "a draft; the final image is being made …" : "a draft is being made …"}`;
      const bytes = await renderFrame({ run: run.id, frame, view: open.view, fine });
      URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(bytes);
      image.alt = `Frame ${frame} by POV-Ray`;
      await image.decode();
    }
    said.textContent = `frame ${frame}, final`;
  } catch (error) {
    said.textContent = `frame ${frame}`;
    problem.textContent = error.message;
    problem.hidden = false;
  }
  button.disabled = false;
  open.rendering = false;
}
