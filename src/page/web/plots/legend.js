// The present values of the curves, and the drift of the runs, beside the plot.

import { short } from "../math.js";

/** Shows names and values. Each row has one value for each run. */
export function showValues(legend, rows) {
  const made = rows.map(({ name, ink, values }) => {
    const [pair, term, what] = ["div", "dt", "dd"].map((tag) => document.createElement(tag));
    term.textContent = name;
    term.style.color = `var(${ink})`;
    what.textContent = values.join(" | ");
    pair.append(term, what);
    return pair;
  });
  legend.replaceChildren(...made);
}

/** Shows the drift of each finished run. */
export function showDrift(drift, runs) {
  const stages = runs.map(({ run }) => run.description).filter(({ settled }) => settled).map(({ stage }) => stage);
  const percent = (stage) => `${short(100 * stage.drift, 2)} %`;
  drift.textContent = stages.length ? `drift ${stages.map(percent).join(" / ")}` : "";
  const scales = [...new Set(stages.map((stage) => stage.drift_scale))].join(" / ");
  drift.title = `The largest energy error, relative to the ${scales}`;
}
