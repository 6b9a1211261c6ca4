// What the viewer wants to see of the chosen body: its trail, arrows of its velocity and of the force on it, and its contacts.

import { contactsByFrame, drawContacts, touches } from "./contacts.js";
import { thing, trail } from "../picture/lines.js";
import { add, isThere, length, times } from "../math.js";
import { element, open, panel, redraw } from "../parts.js";

/** The largest number of points of the trail, and of the moments at which the arrows are known. */
const [MOST_POINTS, MOST_SAMPLES] = [6000, 4000];
/** The length of the arrow of a large value, the greatest length of an arrow, and the radius of lines, as parts of the size of the scene. */
const [ARROW, MOST_ARROW, LINE] = [0.2, 0.4, 0.002];
/** The part of the samples that have no larger value than a large one. Impacts and jerks have values far above it. */
const USUAL = 0.9;
/** The arrows: where their numbers begin among the 15 numbers of a body, and their color. */
const ARROWS = { velocity: { at: 4, color: [0.08, 0.33, 0.75] }, force: { at: 10, color: [0.85, 0.3, 0.08] } };

/** The motion of the body for which an arrow was wanted last. It is fetched when an arrow is first wanted, and again when the run is finished. */
let known = {};

const isWanted = (what) => element(`show-${what}`).checked;

/** Returns a large one of some values, of which few are larger. Undefined if none is positive. */
function large(values) {
  const sorted = values.filter((value) => value > 0).sort((a, b) => a - b);
  return sorted[Math.floor(USUAL * (sorted.length - 1))];
}

async function fetchMotion(run, body) {
  const every = Math.max(1, Math.ceil(run.frames / MOST_SAMPLES));
  const motion = { run, body, every, settled: Boolean(run.progress?.settled) };
  known = motion;
  try {
    const [numbers, contacts] = await Promise.all([run.series(body, 0, run.frames, every), run.contacts(body, 0, run.frames, every)]);
    const sizes = ({ at }) => Array.from({ length: numbers.length / 15 }, (_, k) => length(numbers.subarray(15 * k + at, 15 * k + at + 3)));
    const largest = Object.fromEntries(Object.entries(ARROWS).map(([name, arrow]) => [name, large(sizes(arrow))]));
    const ofContacts = contactsByFrame(contacts);
    const forces = [...ofContacts.values()].flatMap(touches).map(({ normal, friction }) => length(add(normal, friction)));
    Object.assign(motion, { numbers, large: { ...largest, contacts: large(forces) }, contacts: ofContacts });
    redraw();
  } catch (error) {
    if (known === motion && error.status !== 410) known = {};
    if (![404, 410].includes(error.status)) console.warn(error.message);
  }
}

/** Returns the radius of a ball around the center of a body that contains it, m. */
function reach({ description: { pieces } }, body) {
  const own = pieces.filter((piece) => piece.body === body && !piece.plane);
  return Math.max(0, ...own.map((piece) => length(piece.location) + Math.max(...piece.scale)));
}

/** Adds the lines of the chosen body at a position of the film. `at(body)` returns the pose of a body. */
export function showChosen(lines, run, at, position) {
  const { body } = panel;
  if (body === undefined) return;
  const { size } = open.painter.space;
  if (isWanted("trail")) trail(lines, run, { body, radius: LINE * size, color: [0.1, 0.55, 1] }, position, MOST_POINTS);
  const here = at(body);
  if (![...Object.keys(ARROWS), "contacts"].some(isWanted) || !isThere(here)) return;
  const isNew = known.run !== run || known.body !== body || known.settled !== Boolean(run.progress?.settled);
  if (isNew) fetchMotion(run, body);
  const { numbers, large, every, contacts } = known;
  const sample = 15 * Math.round(position / every);
  if (!(sample < numbers?.length)) return;
  if (isWanted("contacts")) {
    const touching = contacts.get(every * Math.round(position / every)) ?? [];
    // Bodies would hide the points at which they touch.
    drawContacts(lines.inFront, touching, large.contacts ?? Infinity, size);
  }
  for (const [name, { at, color }] of Object.entries(ARROWS)) {
    const value = Array.from(numbers.subarray(sample + at, sample + at + 3));
    if (!isWanted(name) || !(large[name] > 0) || !(length(value) > 1e-6 * large[name])) continue;
    const from = here.slice(0, 3);
    const long = Math.min((ARROW * length(value)) / large[name], MOST_ARROW) * size;
    // The length counts from the surface on, so that a large body does not hide the arrow.
    const to = add(from, times(value, (reach(run, body) + long) / length(value)));
    thing(lines, { form: "arrow", from, to, radius: 1.5 * LINE * size, color });
  }
}

/** Draws the picture again when another line is wanted. */
export function listenToChosen() {
  for (const what of ["trail", ...Object.keys(ARROWS), "contacts"]) element(`show-${what}`).onchange = redraw;
}
