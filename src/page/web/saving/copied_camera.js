// The viewer's camera as one of the scene: as a table of the scene language that can be copied, and for images by POV-Ray.

import { element, open, viewpoint } from "../parts.js";

/** The number of digits of the numbers: a thousandth of a pixel cannot be seen. */
const DIGITS = 7;

const rounded = (number) => Number(number.toPrecision(DIGITS));

/** Returns the camera of the scene that shows what the viewer sees: location and target, m, and horizontal angle, degrees. */
export function ownCamera() {
  const canvas = element("picture");
  const { location, look_at, angle } = viewpoint.camera(canvas.clientWidth, canvas.clientHeight, open.run.description.size);
  // A coordinate that is only a rounding error from 0 is 0.
  const least = 1e-9 * viewpoint.distance;
  const point = (p) => p.map((x) => (Math.abs(x) < least ? 0 : rounded(x)));
  return { location: point(location), look_at: point(look_at), angle: rounded(angle) };
}

/** Returns the table `[camera]` that shows what the viewer sees. */
function cameraText() {
  const { location, look_at, angle } = ownCamera();
  return `[camera]\nlocation = [${location.join(", ")}]\nlook_at = [${look_at.join(", ")}]\nangle = ${angle}\n`;
}

/** Copies the table, and shows it. */
export async function copyCamera() {
  if (!open.run || !viewpoint.own) return;
  const text = cameraText();
  element("camera-text").textContent = text;
  let copied = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    copied = false;
  }
  element("camera-said").textContent = copied ? "This is on the clipboard. Paste it into the scene, in place of its camera." : "Copy this into the scene, in place of its camera.";
  element("camera-dialog").showModal();
}
