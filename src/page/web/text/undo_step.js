// Several changes of the text that are undone as one step.

import { Transaction, isolateHistory } from "../libraries/codemirror.js";

/** The time at which the last step of each editor began. */
const times = new WeakMap();

/**
 * Changes the text of an editor. What begins a step is undone apart from the changes before it.
 *
 * The history joins changes of the same time, so a step stays one, however long its source takes between two changes.
 */
export function changeInStep(view, changes, begins) {
  if (begins || !times.has(view)) times.set(view, Date.now());
  const annotations = [Transaction.time.of(times.get(view)), ...(begins ? [isolateHistory.of("before")] : [])];
  view.dispatch({ changes, annotations });
}
