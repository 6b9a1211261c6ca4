// The plots below the picture: energies, momenta and the motion of a body over time, and its paths. A click goes to that time.

import { download } from "../saving/download.js";
import { short } from "../math.js";
import { PlotData } from "./data.js";
import { drawMarks, fontOf, inkOf } from "./drawing.js";
import { layout } from "./layout.js";
import { showDrift, showValues } from "./legend.js";
import { overlay } from "./overlay.js";
import { watch } from "./pointer.js";
import { QUANTITIES, against, curvesOf, nearest } from "./quantities.js";
import { drawingFile, tableFile } from "./saving.js";
import { followed, moved, zoomed } from "./window.js";

/** The height of letters, pixels: usually, and in an enlarged plot. */
const LETTERS = { usual: 11, enlarged: 15 };
/** The time without a further change of the shown range after which finer data is fetched, ms. */
const PAUSE = 150;
/** The time between two fetches while a run is being simulated, ms. */
const INTERVAL = 400;
/** How much a key zooms. */
const KEY_ZOOM = 1.5;

export class Plots {
  /** Takes the elements of the page: the frame of all, the canvas, the choices, the buttons, and what says values. */
  constructor(elements) {
    Object.assign(this, elements);
    this.runs = [];
    this.window = {};
    this.wasOverTime = true;
    this.seek = () => {};
    this.widths = new Map();
    this.base = document.createElement("canvas");
    this.choice.replaceChildren(...QUANTITIES.map(({ name }) => new Option(name)));
    this.offer();
    this.choice.onchange = () => {
      this.offer();
      this.chosen();
    };
    this.against.onchange = () => this.chosen();
    this.difference.onchange = () => this.chosen();
    this.csv.onclick = () => this.saveTable();
    this.svg.onclick = () => this.saveDrawing();
    this.enlarge.onclick = () => this.resize(!this.isLarge);
    this.canvas.onkeydown = (event) => this.pressed(event);
    this.canvas.onfocus = this.canvas.onblur = () => this.paint();
    window.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.isLarge && !document.querySelector("dialog[open]")) this.resize(false);
    });
    watch(this.canvas, this);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.changed());
    new ResizeObserver(() => this.paint()).observe(this.canvas);
  }

  get quantity() {
    return QUANTITIES[this.choice.selectedIndex];
  }

  /** What is across: the time, or a component of a vector. */
  get across() {
    return against(this.quantity)[this.against.selectedIndex];
  }

  get isOverTime() {
    return !this.across.up;
  }

  get isDifference() {
    return this.difference.checked && this.runs.length > 1 && this.isOverTime;
  }

  get isLarge() {
    return this.frame.classList.contains("large");
  }

  /** Identifies the data of the current plot. New data must be fetched when the key changes. */
  get key() {
    return `${this.quantity.of} ${this.quantity.of === "body" ? this.body : ""}`;
  }

  /** The times of the first and the last frame. */
  get times() {
    const run = this.runs[0]?.run;
    const [first, last] = run ? [run.timeAt(0), run.timeAt(run.frames - 1)] : [0, 1];
    return last > first ? [first, last] : [first, first + 1];
  }

  /** The shown range of time. Undefined if all is shown. */
  get range() {
    return this.isOverTime ? this.window.x : undefined;
  }

  /** Offers what the quantity can be plotted against. */
  offer() {
    const before = this.against.value;
    const names = against(this.quantity).map(({ name }) => name);
    this.against.replaceChildren(...names.map((name) => new Option(name)));
    this.against.value = names.includes(before) ? before : names[0];
    this.against.disabled = names.length === 1;
  }

  chosen() {
    // Ranges over time remain while the quantity changes.
    if (!this.isOverTime || !this.wasOverTime) this.window = {};
    this.wasOverTime = this.isOverTime;
    this.changed();
    this.load();
  }

  /** Sets the runs to plot (the shown run, and the compared one) and the chosen body. */
  take(runs, body) {
    const same = this.body === body && runs.length === this.runs.length && runs.every((run, i) => run === this.runs[i].run);
    this.body = body;
    if (!same) {
      const isSameScene = this.runs[0]?.run.description.name === runs[0].description.name;
      this.runs = runs.map((run, k) => this.runs.find((each) => each.run === run) ?? new PlotData(run, isSameScene ? this.runs[k] : undefined));
      const [first, last] = this.times;
      if (!isSameScene || this.window.x?.[0] < first || this.window.x?.[1] > last) this.window = {};
      this.changed();
    }
    this.load();
  }

  /** Fetches new data. While a run is being simulated, data is fetched at most every 0.4 s. */
  async load() {
    const goesOn = this.runs.some(({ run, whole }) => whole && !run.progress?.settled);
    if (goesOn && performance.now() - this.loaded < INTERVAL && this.runs.every(({ whole }) => whole?.key === this.key)) return;
    if (this.loading) {
      this.again = true;
      return;
    }
    this.loading = true;
    do {
      this.again = false;
      this.loaded = performance.now();
      const wanted = { of: this.quantity.of, body: this.body, key: this.key, range: this.range };
      for (const data of this.runs) {
        try {
          await data.load(wanted);
        } catch (error) {
          if (error.status !== 404) console.warn(error.message);
        }
      }
      this.changed();
    } while (this.again);
    this.loading = false;
  }

  /** Marks the present time in the plot. */
  mark(time) {
    if (this.time === time) return;
    if (this.range) this.show({ x: followed(this.range, this.times, this.time, time) });
    this.time = time;
    this.paint();
  }

  /** Composes the plot again, because something in it has changed. */
  changed() {
    this.composed = undefined;
    this.paint();
  }

  /** Shows other ranges. */
  show(window) {
    if (this.window.x === window.x && this.window.y === window.y) return;
    this.window = window;
    this.changed();
    clearTimeout(this.pause);
    this.pause = setTimeout(() => this.load(), PAUSE);
  }

  showAll() {
    this.show({});
  }

  zoom(place, factor) {
    const { composed } = this;
    if (!composed) return;
    const [x, y] = inside(composed.area, place);
    if (this.isOverTime) {
      this.show({ x: zoomed(composed.x, this.times, composed.atX(x), factor, this.shortest) ?? undefined });
      return;
    }
    // Both ranges of a path are zoomed alike.
    if (!this.window.x) this.all = { x: composed.x, y: composed.y };
    const across = zoomed(composed.x, this.all.x, composed.atX(x), factor);
    const up = zoomed(composed.y, this.all.y, composed.atY(y), factor);
    this.show(across && up ? { x: across, y: up } : {});
  }

  /** The shortest range of time that is shown: four frames. */
  get shortest() {
    const [first, last] = this.times;
    return (4 * (last - first)) / Math.max(4, this.runs[0]?.run.frames ?? 0);
  }

  shift(x, y) {
    const { composed, window } = this;
    if (!composed || !window.x) return;
    const across = composed.atX(0) - composed.atX(x);
    if (this.isOverTime) this.show({ x: moved(window.x, this.times, across) });
    else this.show({ x: moved(window.x, this.all.x, across), y: moved(window.y, this.all.y, composed.atY(0) - composed.atY(y)) });
  }

  point(place) {
    this.pointer = place;
    this.paint();
  }

  /** Goes to the time at a place: of a path, to the time of its nearest point. */
  go(place) {
    const { composed } = this;
    if (!composed) return;
    const time = this.timeAt(place);
    if (time !== undefined) this.seek(time);
  }

  timeAt(place) {
    const { composed } = this;
    const [x, y] = inside(composed.area, place);
    if (this.isOverTime) return composed.atX(x);
    const [curve] = composed.curves;
    let [least, time] = [Infinity, undefined];
    curve?.xs.forEach((value, k) => {
      const away = Math.hypot(composed.toX(value) - x, composed.toY(curve.ys[k]) - y);
      if (away < least) [least, time] = [away, curve.times[k]];
    });
    return time;
  }

  pressed(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const deeds = { "+": () => this.zoomHere(1 / KEY_ZOOM), "=": () => this.zoomHere(1 / KEY_ZOOM), "-": () => this.zoomHere(KEY_ZOOM), 0: () => this.showAll(), Enter: () => this.tell() };
    if (!deeds[event.key]) return;
    event.preventDefault();
    event.stopPropagation();
    deeds[event.key]();
  }

  /** Zooms about the present moment if it is shown, otherwise about the middle. */
  zoomHere(factor) {
    const { composed } = this;
    if (!composed) return;
    const { area, toX, toY } = composed;
    const { x, points } = this.placesAt(this.time ?? 0);
    const [across, up] = [toX(x), toY(points[0]?.y ?? NaN)];
    const isIn = across >= area.left && across <= area.left + area.width;
    this.zoom([isIn ? across : area.left + area.width / 2, isIn && up ? up : area.top + area.height / 2], factor);
  }

  /** Returns the curves. Those over the part that is shown have more points, those over the whole run have the present moment. */
  curves(range = this.range) {
    const numbers = this.runs.map((data) => data.numbers(this.quantity.of, range));
    return curvesOf(this.quantity, this.across, numbers, this.isDifference);
  }

  /** Returns the place across at a time, and the points of all curves. */
  placesAt(time) {
    const { curves, overall } = this.composed;
    const isIn = ({ times }) => times[0] <= time && time <= times.at(-1);
    const points = (curves.every(isIn) ? curves : overall).map(({ name, ink, which, times, xs, ys }) => {
      const at = nearest(times, time);
      return { name, ink, which, time: times[at], x: xs[at] ?? NaN, y: ys[at] ?? NaN };
    });
    return { x: points[0]?.x ?? NaN, points };
  }

  /** Returns the names and values at a time: of each quantity, one value for each run. */
  valuesAt(time) {
    const { points } = this.placesAt(time);
    const { unit } = this.across.up ?? this.quantity;
    const written = (value, unit) => (Number.isNaN(value) ? "–" : `${short(value)}${unit ? ` ${unit}` : ""}`);
    const first = points.filter(({ which }) => !which);
    const rows = first.map(({ name, ink }) => ({ name, ink, values: points.filter((point) => point.name === name).map(({ y }) => written(y, unit)) }));
    if (this.isOverTime) return { time: first[0]?.time ?? time, rows };
    const { name, unit: length } = this.across.across;
    return { time: first[0]?.time ?? time, rows: [{ name, ink: "--quiet", values: points.map(({ x }) => written(x, length)) }, ...rows] };
  }

  /** The names of the runs that are compared: their methods, with their steps if the methods are the same. */
  get styles() {
    if (this.runs.length < 2 || this.isDifference) return [];
    const [a, b] = this.runs.map(({ run }) => run.description);
    if (a.integrator !== b.integrator) return [a.integrator, b.integrator];
    const step = ({ step }) => `${short(step)} s`;
    return step(a) === step(b) ? [a.integrator, "compared"] : [`${a.integrator}, ${step(a)}`, step(b)];
  }

  /** Describes the plot for its layout. */
  get plot() {
    const { quantity, across, isOverTime } = this;
    const isOfBody = quantity.of === "body";
    const body = isOfBody ? this.runs[0]?.run.description.bodies[this.body]?.name : undefined;
    const name = quantity.name.replace("Body: ", "");
    const brief = across.up?.name ?? `${name}${this.isDifference ? ", difference" : ""}`;
    const curves = this.curves();
    return {
      curves,
      overall: this.range ? this.curves(null) : curves,
      window: this.window,
      whole: isOverTime ? this.times : undefined,
      equal: across.equal,
      styles: this.styles,
      hasNoNames: !isOverTime || curves.every((curve) => curve.name === name.toLowerCase()),
      across: { label: across.across.name, unit: across.across.unit },
      up: { label: body === undefined ? brief : `${body}: ${brief}`, brief, unit: (across.up ?? quantity).unit, whole: quantity.counts },
      note: isOfBody && this.body === undefined ? "Choose a body: click it in the picture." : undefined,
    };
  }

  measure(size) {
    const context = this.base.getContext("2d");
    return (text) => {
      const key = `${size} ${text}`;
      if (!this.widths.has(key)) {
        if (this.widths.size > 2000) this.widths.clear();
        context.font = fontOf(size);
        this.widths.set(key, context.measureText(text).width);
      }
      return this.widths.get(key);
    };
  }

  paint() {
    const { canvas, base } = this;
    const scale = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
    const size = this.isLarge && width > 500 ? LETTERS.enlarged : LETTERS.usual;
    const measure = this.measure(size);
    if (canvas.width !== w || canvas.height !== h || this.composed?.size !== size) {
      for (const each of [canvas, base]) Object.assign(each, { width: w, height: h });
      this.composed = undefined;
    }
    if (!this.composed) {
      const { plot } = this;
      this.composed = Object.assign(layout(plot, { width, height, size, measure }), { plot, curves: plot.curves, overall: plot.overall });
      this.ink = inkOf(document.documentElement);
      const context = base.getContext("2d");
      context.setTransform(scale, 0, 0, scale, 0, 0);
      context.clearRect(0, 0, width, height);
      drawMarks(context, this.composed.marks, this.composed, this.ink);
    }
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, w, h);
    context.drawImage(base, 0, 0);
    context.setTransform(scale, 0, 0, scale, 0, 0);
    drawMarks(context, this.marksOver(measure), this.composed, this.ink);
    this.say();
  }

  /** Returns the marks of the present moment, and of the values under the pointer. With the focus by keyboard, these are the present values. */
  marksOver(measure) {
    const { composed, time } = this;
    const now = time === undefined ? undefined : { ...this.placesAt(time), x: this.isOverTime ? time : this.placesAt(time).x };
    const asked = this.pointer ? this.timeAt(this.pointer) : this.canvas.matches(":focus-visible") ? time : undefined;
    if (asked === undefined || !composed.curves.length || !composed.curves[0].times.length) return overlay(composed, composed.plot, now, undefined, measure);
    const { time: at, rows } = this.valuesAt(asked);
    const head = { cells: [`t = ${short(at, 5)} s`, ...rows[0].values.map((_, k) => this.styles[k] ?? "")] };
    const there = { ...this.placesAt(asked), rows: [head, ...rows.map(({ name, ink, values }) => ({ cells: [name, ...values], ink }))] };
    return overlay(composed, composed.plot, now, there, measure);
  }

  /** Shows the present values. */
  say() {
    showValues(this.legend, this.valuesAt(this.time ?? 0).rows);
    showDrift(this.drift, this.runs);
    this.difference.parentElement.hidden = this.runs.length < 2 || !this.isOverTime;
    const what = this.isOverTime ? `${this.quantity.name} over time` : `${this.quantity.name}, ${this.across.name}`;
    const label = `Plot: ${what}. Arrow keys move the time; plus, minus and 0 zoom; Enter tells the values.`;
    if (this.canvas.getAttribute("aria-label") !== label) this.canvas.setAttribute("aria-label", label);
  }

  /** Says the present values, for screen readers. */
  tell() {
    const { time, rows } = this.valuesAt(this.time ?? 0);
    this.said.textContent = `t ${short(time, 5)} s: ${rows.map(({ name, values }) => `${name} ${values.join(" and ")}`).join(", ")}`;
  }

  resize(large) {
    this.frame.classList.toggle("large", large);
    this.enlarge.setAttribute("aria-pressed", large);
    this.enlarge.title = large ? "Make the plot small again (Esc)" : "Make the plot larger";
    this.paint();
  }

  /** Saves the shown numbers as a table. */
  async saveTable() {
    if (!this.runs.length) return;
    try {
      this.saved(await tableFile(this));
    } catch (error) {
      this.said.textContent = error.message;
    }
  }

  /** Saves the plot as a drawing. */
  saveDrawing() {
    if (this.runs.length) this.saved(drawingFile(this));
  }

  saved({ blob, name }) {
    download(blob, name);
    this.said.textContent = `${name} is saved.`;
  }
}

/** Returns the place in an area that is nearest to a place. */
function inside({ left, top, width, height }, [x, y]) {
  return [Math.max(left, Math.min(left + width, x)), Math.max(top, Math.min(top + height, y))];
}
