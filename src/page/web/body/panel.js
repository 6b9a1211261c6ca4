// The panel with the values of the chosen body.

import { contactsByFrame, touches } from "./contacts.js";
import { isThere, length, short } from "../math.js";

/** The number of frames whose values of a body are fetched together. */
const BLOCK = 200;

export class Panel {
  constructor(elements) {
    Object.assign(this, elements);
    this.body = undefined;
    this.blocks = new Map();
    this.chosen = () => {};
    this.name.onchange = () => this.choose(this.numbers?.get(this.name.value));
  }

  take(run) {
    const before = this.run?.description.bodies[this.body]?.name;
    this.run = run;
    this.blocks.clear();
    this.numbers = new Map(run.description.bodies.map(({ name }, number) => [name, number]));
    this.names.replaceChildren(...run.description.bodies.slice(0, 500).map(({ name }) => new Option(name)));
    this.choose(this.numbers.get(before));
  }

  choose(body) {
    this.body = body;
    this.blocks.clear();
    this.name.value = this.run?.description.bodies[body]?.name ?? "";
    if (body === undefined) this.values.replaceChildren();
    this.shows.hidden = body === undefined;
    this.showsContacts.hidden = !this.run?.description.contacts;
    this.chosen(body);
  }

  /** Shows the values of the body in a frame. */
  async show(frame) {
    const { run, body } = this;
    if (!run || body === undefined || frame >= (run.progress?.recorded ?? 0) || this.without === run) return;
    this.frame = frame;
    const number = Math.floor(frame / BLOCK);
    const at = 15 * (frame % BLOCK);
    const known = this.blocks.get(number);
    if (!(known?.block.length >= at + 15)) {
      if (this.asking) return;
      this.asking = true;
      try {
        const frames = [body, number * BLOCK, (number + 1) * BLOCK];
        const block = await run.series(...frames);
        // Asked for later, they are known at least as far as the series.
        const contacts = await run.contacts(...frames);
        if (run === this.run && body === this.body) this.blocks.set(number, { block, contacts: contactsByFrame(contacts) });
      } catch (error) {
        if (error.status === 410) {
          this.without = run;
          this.values.createCaption().textContent = error.message;
        } else if (error.status !== 404) console.warn(error.message);
      }
      this.asking = false;
      if (this.blocks.get(number)?.block.length >= at + 15 || this.frame !== frame) this.show(this.frame);
      return;
    }
    const n = known.block.subarray(at, at + 15);
    const description = run.description.bodies[body];
    const three = (i) => Array.from(n.subarray(i, i + 3));
    // A component that differs from zero only by a rounding error is shown as 0.
    const written = (v, unit) => `${v.map((c) => short(Math.abs(c) < 1e-12 * length(v) ? 0 : c)).join(", ")} ${unit}`;
    this.fill([
      ["kind", { free: "moves freely", fixed: "fixed", driven: "its motion is given" }[description.kind]],
      ["mass", `${short(description.mass)} kg`],
      ["time", `${short(n[0], 6)} s`],
      ...(isThere(three(1)) ? [] : [["now", "not there"]]),
      ["location", written(three(1), "m")],
      ["velocity", written(three(4), "m/s")],
      ["speed", `${short(length(three(4)))} m/s`],
      ["angular velocity", written(three(7), "rad/s")],
      ["force", written(three(10), "N")],
      ...touches(known.contacts.get(frame) ?? []).map((touch) => ["touches", this.touch(touch)]),
      ["kinetic energy", `${short(n[13])} J`],
      ...(Number.isNaN(n[14]) ? [] : [["impacts", short(n[14])]]),
    ]);
  }

  /** Says which body touches the chosen one, and with which forces. */
  touch({ other, normal, friction }) {
    const name = this.run.description.bodies[other]?.name ?? "the ground";
    const [pressing, rubbing] = [normal, friction].map(length);
    return `${name}, ${short(pressing)} N${rubbing > 1e-9 * pressing ? `, friction ${short(rubbing)} N` : ""}`;
  }

  fill(rows) {
    const made = rows.map(([name, value]) => {
      const [row, head, cell] = ["tr", "th", "td"].map((tag) => document.createElement(tag));
      head.textContent = name;
      head.scope = "row";
      cell.textContent = value;
      row.append(head, cell);
      return row;
    });
    this.values.replaceChildren(...made);
  }
}
