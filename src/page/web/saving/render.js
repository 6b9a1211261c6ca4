// Renders the current frame with POV-Ray, and shows the image beside the picture.

import { ownCamera } from "./copied_camera.js";
import { element, open, player, redraw, viewpoint } from "../parts.js";
import { renderFrame } from "../source.js";

export async function renderThis() {
  const { run } = open;
  if (!run || open.rendering) return;
  player.pause();
  redraw();
  const { frame } = player;
  // The camera of the scene, or the viewer's own.
  const own = viewpoint.own ? ownCamera() : undefined;
  const what = `frame ${frame}${own ? ", own camera" : ""}`;
  const [button, image, said, problem] = ["render", "rendered", "render-status", "render-problem"].map(element);
  element("image").hidden = false;
  open.rendering = true;
  button.disabled = true;
  problem.hidden = true;
  try {
    for (const fine of [false, true]) {
      said.textContent = `${what}: ${fine ? "a draft; the final image is being made …" : "a draft is being made …"}`;
      const bytes = await renderFrame({ run: run.id, frame, view: open.view, own, fine });
      URL.revokeObjectURL(image.src);
      image.src = URL.createObjectURL(bytes);
      image.alt = `Frame ${frame} by POV-Ray${own ? ", seen by your own camera" : ""}`;
      await image.decode();
    }
    said.textContent = `${what}, final`;
  } catch (error) {
    said.textContent = what;
    problem.textContent = error.message;
    problem.hidden = false;
  }
  button.disabled = false;
  open.rendering = false;
}
