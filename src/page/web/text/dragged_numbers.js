// Numbers in the text that are dragged with Alt held, or stepped by keys. The last digit changes by one; with Shift, by ten.

import { EditorView } from "../libraries/codemirror.js";
import { changeInStep } from "./undo_step.js";

/** The way of the pointer for one step, pixels. */
const STEP_WAY = 4;
const NUMBER = /(?<![\w.])[-+]?\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])/g;

/** Returns the number at a position of the text. Signs after a value are operators of a formula. */
function numberAt({ doc }, position) {
  const { from, text } = doc.lineAt(position);
  for (const { 0: whole, index } of text.matchAll(NUMBER)) {
    const isOperator = /^[-+]/.test(whole) && /[\w)]\s*$/.test(text.slice(0, index));
    const start = from + index + (isOperator ? 1 : 0);
    const end = from + index + whole.length;
    if (start <= position && position <= end) return { from: start, to: end, text: doc.sliceString(start, end) };
  }
  return undefined;
}

/** Returns the text of a number after some steps of its last digit. */
export function stepped(text, steps) {
  const [, digits, exponent = ""] = /^([-+]?[\d_.]+)([eE].*)?$/.exec(text);
  const decimals = digits.split(".")[1]?.length ?? 0;
  const value = Number(digits.replaceAll("_", "")) + steps * 10 ** -decimals;
  // No number is written as -0.
  return (Math.abs(value) < 0.5 * 10 ** -decimals ? 0 : value).toFixed(decimals) + exponent;
}

/** Steps the number at the cursor. */
const byKey = (steps) => (view) => {
  const number = numberAt(view.state, view.state.selection.main.head);
  if (!number) return false;
  view.dispatch({ changes: { from: number.from, to: number.to, insert: stepped(number.text, steps) } });
  return true;
};

export const numberKeys = [
  { key: "Ctrl-ArrowUp", run: byKey(1), shift: byKey(10) },
  { key: "Ctrl-ArrowDown", run: byKey(-1), shift: byKey(-10) },
];

/** Follows the pointer from a number on until it is released. */
function drag(view, number, begun) {
  const { from, text } = number;
  let last = text;
  let hasBegun = false;
  const move = (event) => {
    const steps = Math.round((event.clientX - begun.clientX) / STEP_WAY) * (event.shiftKey ? 10 : 1);
    const next = stepped(text, steps);
    if (next === last) return;
    changeInStep(view, { from, to: from + last.length, insert: next }, !hasBegun);
    [last, hasBegun] = [next, true];
  };
  const end = () => window.removeEventListener("pointermove", move);
  window.addEventListener("pointermove", move);
  window.addEventListener("pointerup", end, { once: true });
}

export const draggedNumbers = EditorView.domEventHandlers({
  mousedown(event, view) {
    const position = event.altKey && event.button === 0 ? view.posAtCoords({ x: event.clientX, y: event.clientY }) : null;
    const number = position !== null && numberAt(view.state, position);
    if (!number) return false;
    event.preventDefault();
    drag(view, number, event);
    return true;
  },
});
