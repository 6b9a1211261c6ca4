// The files of a plot: its numbers as a table, and a drawing for paper.

import { asSvg, inkOf } from "./drawing.js";
import { layout } from "./layout.js";
import { curvesOf } from "./quantities.js";
import { tableOf } from "./table.js";

/** The size of a drawing, and the height of its letters, pixels. */
const PAPER = { width: 700, height: 400, size: 14 };

/** Returns the name of a file, without its ending: `SCENE-energy`. */
function nameOf({ runs: [{ run }], quantity, across, body, isDifference, isOverTime }) {
  const { name: scene, bodies } = run.description;
  const what = isOverTime ? quantity.name.replace("Body: ", "") : across.name.replace(" – ", "-");
  const parts = [quantity.of === "body" ? bodies[body]?.name : undefined, what, isDifference ? "difference" : undefined];
  const plain = (text) => text.toLowerCase().replace(/[^\p{L}\p{N}_]+/gu, "-").replace(/^-|-$/g, "");
  return [scene, ...parts.filter(Boolean).map(plain)].join("-");
}

/** Returns a table of every frame in the shown range. */
export async function tableFile(plots) {
  const { runs, quantity, across, body, range, isDifference, isOverTime, styles } = plots;
  const name = `${nameOf(plots)}.csv`;
  const numbers = await Promise.all(runs.map((data) => data.all({ of: quantity.of, body, range })));
  const columns = curvesOf(quantity, across, numbers, isDifference).flatMap((curve) => {
    const shown = Array.from(curve.times, (time) => !range || (time >= range[0] && time <= range[1]));
    const only = (values) => values.filter((_, k) => shown[k]);
    const column = (name, unit, values) => {
      const run = styles[curve.which] ? `${styles[curve.which]}: ` : "";
      const heading = `${run}${name}${isDifference ? " difference" : ""}${unit ? ` (${unit})` : ""}`;
      return { heading, times: only(curve.times), values: only(values) };
    };
    const { name: first, unit } = across.across;
    return [...(isOverTime ? [] : [column(first, unit, curve.xs)]), column(curve.name, (across.up ?? quantity).unit, curve.ys)];
  });
  return { blob: new Blob([tableOf("t (s)", columns)], { type: "text/csv" }), name };
}

/** Returns a drawing as SVG. The paper is white, so the colors are those of the light page. */
export function drawingFile(plots) {
  const light = document.createElement("div");
  light.className = "on-paper";
  document.body.append(light);
  const drawing = asSvg(layout(plots.plot, { ...PAPER, measure: plots.measure(PAPER.size) }), inkOf(light));
  light.remove();
  return { blob: new Blob([drawing], { type: "image/svg+xml" }), name: `${nameOf(plots)}.svg` };
}
