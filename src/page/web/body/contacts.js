// The contacts of a body: the points at which it touches others, and the forces there.

import { thing } from "../picture/lines.js";
import { add, length, times } from "../math.js";

/** The number of values of a contact in the data of a run. */
const NUMBERS = 11;
/** The radius of the ball at a point of contact, and that of an arrow, as parts of the size of the scene. */
const [POINT, SHAFT] = [0.009, 0.005];
/** The length of the arrow of a large force, the greatest length of an arrow, and the least, as parts of the size of the scene. */
const [ARROW, MOST_ARROW, LEAST_ARROW] = [0.3, 0.5, 0.01];
const POINT_COLOR = [0.95, 0.8, 0.1];
/** The colors of the arrows of normal forces and of friction. */
const COLORS = { normal: [0.1, 0.55, 0.2], friction: [0.7, 0.15, 0.6] };

/** Returns the contacts of several frames, by the number of the frame. */
export function contactsByFrame(numbers) {
  const frames = new Map();
  for (let i = 0; i < numbers.length; i += NUMBERS) {
    const [frame, other, ...values] = numbers.subarray(i, i + NUMBERS);
    const contact = { other, place: values.slice(0, 3), normal: values.slice(3, 6), friction: values.slice(6, 9) };
    frames.set(frame, [...(frames.get(frame) ?? []), contact]);
  }
  return frames;
}

/** Returns the forces from each other body that one touches: the sums over their points of contact, and the center of pressure. */
export function touches(contacts) {
  return [...new Set(contacts.map(({ other }) => other))].map((other) => {
    const points = contacts.filter((contact) => contact.other === other);
    const sum = (vector) => points.map(vector).reduce(add);
    const pressed = points.reduce((whole, { normal }) => whole + length(normal), 0);
    const part = ({ normal }) => (pressed > 0 ? length(normal) / pressed : 1 / points.length);
    return {
      other,
      place: sum((point) => times(point.place, part(point))),
      normal: sum(({ normal }) => normal),
      friction: sum(({ friction }) => friction),
    };
  });
}

/** Adds the contacts of a frame: a ball at each point, and for each other body an arrow of its normal force and one of its friction. */
export function drawContacts(lines, contacts, largeForce, size) {
  for (const { place } of contacts) thing(lines, { form: "ball", at: place, radius: POINT * size, color: POINT_COLOR });
  for (const touch of touches(contacts)) {
    for (const [name, color] of Object.entries(COLORS)) {
      const force = touch[name];
      const long = Math.min((ARROW * length(force)) / largeForce, MOST_ARROW);
      if (!(long > LEAST_ARROW)) continue;
      const to = add(touch.place, times(force, (long * size) / length(force)));
      thing(lines, { form: "arrow", from: touch.place, to, radius: SHAFT * size, color });
    }
  }
}
