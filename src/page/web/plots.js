// Plots energies, momenta and the motion of a body over time. A click on a plot goes to that time.

import { short } from "./math.js";

/** The largest number of points across a plot. */
const POINTS = 4000;
const INK = { first: "--kinetic", second: "--potential", third: "--total" };

/** The available plots. Their values come from the 13 numbers of a frame's balance, or from the 15 numbers of a body. */
export const PLOTS = [
  { name: "Energy", unit: "J", of: "balance", curves: [["kinetic", INK.first, (n, i) => n[i + 1]], ["potential", INK.second, (n, i) => n[i + 2]], ["total", INK.third, (n, i) => n[i + 3]]] },
  { name: "Drift", unit: "J", of: "balance", curves: [["total − work", INK.third, (n, i) => n[i + 3] - n[i + 4]]] },
  { name: "Momentum", unit: "kg m/s", of: "balance", curves: vector(6) },
  { name: "Angular momentum", unit: "kg m²/s", of: "balance", curves: vector(9) },
  { name: "Impacts", unit: "", of: "balance", curves: [["impacts", INK.first, (n, i) => n[i + 12]]] },
  { name: "Body: location", unit: "m", of: "body", curves: vector(1) },
  { name: "Body: velocity", unit: "m/s", of: "body", curves: vector(4) },
  { name: "Body: angular velocity", unit: "rad/s", of: "body", curves: vector(7) },
  { name: "Body: force", unit: "N", of: "body", curves: vector(10) },
  { name: "Body: kinetic energy", unit: "J", of: "body", curves: [["kinetic", INK.first, (n, i) => n[i + 13]]] },
  { name: "Body: impacts", unit: "", of: "body", curves: [["impacts", INK.first, (n, i) => n[i + 14]]] },
];

function vector(at) {
  return [["x", INK.first, (n, i) => n[i + at]], ["y", INK.second, (n, i) => n[i + at + 1]], ["z", INK.third, (n, i) => n[i + at + 2]]];
}

export class Plots {
  constructor({ canvas, choice, legend, drift }) {
    Object.assign(this, { canvas, choice, legend, drift });
    choice.replaceChildren(...PLOTS.map(({ name }) => new Option(name)));
    choice.onchange = () => this.load();
    this.runs = [];
    this.seek = () => {};
    const go = (event) => {
      const box = canvas.getBoundingClientRect();
      this.seek(((event.clientX - box.left) / box.width) * this.end);
    };
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      go(event);
    };
    canvas.onpointermove = (event) => event.buttons && go(event);
    new ResizeObserver(() => this.paint()).observe(canvas);
  }

  get plot() {
    return PLOTS[this.choice.selectedIndex];
  }

  /** Identifies the data of the current plot. New data must be fetched when the key changes. */
  get key() {
    return `${this.plot.of} ${this.plot.of === "body" ? this.body : ""}`;
  }

  get end() {
    const run = this.runs[0]?.run;
    return run ? run.timeAt(run.frames - 1) || 1 : 1;
  }

  /** Sets the runs to plot (the shown run, and the compared one) and the chosen body. */
  take(runs, body) {
    const same = this.body === body && runs.length === this.runs.length && runs.every((run, i) => run === this.runs[i].run);
    this.body = body;
    if (!same) this.runs = runs.map((run) => ({ run, numbers: undefined, of: undefined, recorded: -1 }));
    this.load();
  }

  /** Fetches new data. While a run is being simulated, data is fetched at most every 0.4 s. */
  async load() {
    const goesOn = this.runs.some(({ run, numbers }) => numbers && !run.progress?.settled);
    if (goesOn && performance.now() - this.loaded < 400 && this.runs.every(({ of }) => of === this.key)) return;
    if (this.loading) {
      this.again = true;
      return;
    }
    this.loading = true;
    do {
      this.again = false;
      const { plot, body, key } = this;
      this.loaded = performance.now();
      for (const each of this.runs) {
        const recorded = each.run.progress?.recorded ?? 0;
        if (each.of === key && each.recorded === recorded) continue;
        try {
          const every = Math.max(1, Math.ceil(each.run.frames / POINTS));
          const numbers = plot.of === "balance" ? await each.run.balance(POINTS) : body === undefined ? new Float64Array() : await each.run.series(body, 0, each.run.frames, every);
          Object.assign(each, { numbers, of: key, recorded });
        } catch (error) {
          if (error.status !== 404) console.warn(error.message);
        }
      }
      this.paint();
    } while (this.again);
    this.loading = false;
  }

  /** Marks the present time in the plot. */
  mark(time) {
    if (this.time === time) return;
    this.time = time;
    this.paint();
  }

  paint() {
    const { canvas, plot } = this;
    const scale = window.devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(w * scale) || canvas.height !== Math.round(h * scale)) {
      canvas.width = Math.round(w * scale);
      canvas.height = Math.round(h * scale);
    }
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, w, h);
    const style = getComputedStyle(document.documentElement);
    const ink = (name) => style.getPropertyValue(name).trim();
    const stride = plot.of === "balance" ? 13 : 15;
    const shown = this.runs.filter((each) => each.numbers?.length && each.of?.startsWith(plot.of));
    let [low, high] = [Infinity, -Infinity];
    for (const { numbers } of shown) {
      for (let i = 0; i < numbers.length; i += stride) {
        for (const [, , value] of plot.curves) {
          const v = value(numbers, i);
          if (v < low) low = v;
          if (v > high) high = v;
        }
      }
    }
    if (!(high >= low)) [low, high] = [0, 1];
    const room = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
    [low, high] = [low - room, high + room];
    const y = (value) => h - ((value - low) / (high - low)) * h;
    const x = (time) => (time / this.end) * w;
    context.font = "11px system-ui";
    context.strokeStyle = ink("--line");
    context.fillStyle = ink("--quiet");
    context.lineWidth = 1;
    for (const level of levels(low, high, 3)) {
      line(context, [[0, y(level)], [w, y(level)]]);
    }
    shown.forEach(({ numbers }, which) => {
      context.setLineDash(which ? [5, 4] : []);
      context.lineWidth = which ? 1 : 1.6;
      for (const [, color, value] of plot.curves) {
        context.strokeStyle = ink(color);
        let points = [];
        for (let i = 0; i < numbers.length; i += stride) {
          const v = value(numbers, i);
          if (!Number.isNaN(v)) {
            points.push([x(numbers[i]), y(v)]);
          } else if (points.length) {
            // An absent body has no curve, so the curve is interrupted.
            line(context, points);
            points = [];
          }
        }
        if (points.length) line(context, points);
      }
    });
    context.setLineDash([]);
    // The labels are drawn over all curves, with an outline in the color of the background.
    context.strokeStyle = ink("--paper");
    context.lineWidth = 3;
    for (const level of levels(low, high, 3)) {
      const place = [short(level), 2, Math.max(10, y(level) - 3)];
      context.strokeText(...place);
      context.fillText(...place);
    }
    if (this.time !== undefined) {
      context.strokeStyle = ink("--accent");
      context.lineWidth = 1.5;
      line(context, [[x(this.time), 0], [x(this.time), h]]);
    }
    if (plot.of === "body" && this.body === undefined) {
      context.fillStyle = ink("--quiet");
      context.fillText("Choose a body: click it in the picture.", 12, h / 2);
    }
    this.say(shown[0]?.numbers, stride, plot);
  }

  /** Shows the values at the present time. */
  say(numbers, stride, plot) {
    const rows = plot.curves.flatMap(([name, color, value]) => {
      const [term, what] = [document.createElement("dt"), document.createElement("dd")];
      term.textContent = name;
      term.style.color = `var(${color})`;
      const at = numbers ? nearest(numbers, stride, this.time ?? 0) : undefined;
      // Without contacts, impacts are not counted, and the value is unknown.
      const isKnown = at !== undefined && !Number.isNaN(value(numbers, at));
      what.textContent = isKnown ? `${short(value(numbers, at))} ${plot.unit}` : "–";
      return [term, what];
    });
    this.legend.replaceChildren(...rows);
    const stages = this.runs.map(({ run }) => run.description).filter(({ settled }) => settled).map(({ stage }) => stage);
    const percent = (stage) => `${short(100 * stage.drift, 2)} %`;
    this.drift.textContent = stages.length ? `drift ${stages.map(percent).join(" / ")}` : "";
    const scales = [...new Set(stages.map((stage) => stage.drift_scale))].join(" / ");
    this.drift.title = `The largest energy error, relative to the ${scales}`;
  }
}

function line(context, points) {
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

/** Returns about `count` round numbers between two values. */
function levels(low, high, count) {
  const raw = (high - low) / count;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((s) => s * decade).find((s) => s >= raw) ?? raw;
  const out = [];
  for (let level = Math.ceil(low / step) * step; level <= high && out.length < 10; level += step) out.push(Math.abs(level) < step * 1e-9 ? 0 : level);
  return out;
}

/** Returns the index at which the numbers of the nearest time begin. */
function nearest(numbers, stride, time) {
  const count = numbers.length / stride;
  if (!count) return undefined;
  let [before, after] = [0, count - 1];
  while (after - before > 1) {
    const middle = (before + after) >> 1;
    if (numbers[stride * middle] <= time) before = middle;
    else after = middle;
  }
  return stride * (time - numbers[stride * before] < numbers[stride * after] - time ? before : after);
}
