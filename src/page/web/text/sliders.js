// The sliders of the scene's variables.

import { short } from "../math.js";
import { element, redraw } from "../parts.js";
import { CAN_COMPUTE, MOVED, setVariable } from "../source.js";
import { isEdited, setInText } from "./scene_text.js";

/** The number of steps of a slider whose scene gives none: at least this many. */
const MIN_STEPS = 100;

/** The newest value of each variable that the source has not taken yet. */
const waiting = new Map();
/** The values that runs on their way will have. A run with another value is an older one, and moves no slider. */
const expected = new Map();
let sending = false;
/** The sliders that are on the page, as text. */
let known = "";

/** Returns a round step that divides the range of a slider finely. */
function stepOf({ min, max, step }) {
  if (step) return step;
  const raw = (max - min) / MIN_STEPS;
  const decade = 10 ** Math.floor(Math.log10(raw));
  return [5, 2, 1].map((part) => part * decade).find((part) => part <= raw * 1.0001) ?? decade;
}

/** Returns the value without the rounding error of the browser's arithmetic. */
const rounded = (value) => Number(value.toPrecision(12));

/** Returns what finds the place of a slider's value in the text. */
const placeOf = (name, value) => ({ sliders }) => {
  const slider = sliders.find(({ variable }) => variable === name);
  if (!slider) throw new Error(`There is no slider of \`${name}\` any more.`);
  return [{ place: slider.place, value }];
};

/** Sends the newest values, one after another. A value that has been replaced meanwhile is not sent. */
async function send() {
  if (sending) return;
  sending = true;
  while (waiting.size) {
    const [[name, value]] = waiting;
    waiting.delete(name);
    try {
      const isInText = isEdited();
      await (isInText ? setInText(name, placeOf(name, value)) : setVariable(name, value));
      element("sliders-said").textContent = isInText ? "" : MOVED;
    } catch (error) {
      expected.delete(name);
      element("sliders-said").textContent = error.message;
    }
    await new Promise(requestAnimationFrame);
  }
  sending = false;
}

function row(slider) {
  const [label, title, input, value] = ["label", "span", "input", "output"].map((tag) => document.createElement(tag));
  const isSwitch = slider.min === 0 && slider.max === 1 && slider.step === 1;
  title.textContent = slider.title;
  input.type = isSwitch ? "checkbox" : "range";
  input.name = slider.variable;
  const show = (number) => {
    value.textContent = isSwitch ? "" : `${short(number)}${slider.unit ? ` ${slider.unit}` : ""}`;
    input.setAttribute("aria-valuetext", value.textContent);
  };
  const put = (number) => {
    if (isSwitch) input.checked = number !== 0;
    else input.value = number;
    show(number);
  };
  if (!isSwitch) Object.assign(input, { min: slider.min, max: slider.max, step: stepOf(slider) });
  input.oninput = () => {
    const number = isSwitch ? Number(input.checked) : rounded(Math.min(slider.max, Math.max(slider.min, Number(input.value))));
    show(number);
    waiting.set(slider.variable, number);
    expected.set(slider.variable, number);
    send();
    redraw();
  };
  label.append(title, input, value);
  put(slider.value);
  return { label, put };
}

let rows = new Map();

/** Shows the sliders of a run. */
export function showSliders({ description: { sliders } }) {
  const text = JSON.stringify(sliders.map(({ variable, title, unit, min, max, step }) => [variable, title, unit, min, max, step]));
  if (text !== known) {
    known = text;
    expected.clear();
    rows = new Map(sliders.map((slider) => [slider.variable, row(slider)]));
    element("sliders-list").replaceChildren(...[...rows.values()].map(({ label }) => label));
    element("sliders-said").textContent = "";
    element("sliders").hidden = !CAN_COMPUTE || !sliders.length;
    return;
  }
  for (const { variable, value } of sliders) {
    if (expected.has(variable) && expected.get(variable) !== value) continue;
    expected.delete(variable);
    rows.get(variable).put(value);
  }
}
