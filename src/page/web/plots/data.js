// The data of a run for the plots: over the whole run, and finer over the part that is shown.

/** The largest number of frames of a plot. */
const POINTS = 4000;

export class PlotData {
  /** Until its own numbers are fetched, a run is plotted with those of the run before it, so that the plot does not vanish while a slider is moved. */
  constructor(run, before) {
    this.run = run;
    /** The numbers over the whole run, and those over the part that is shown. Each knows of what, and from which frames. */
    this.whole = before?.whole && { ...before.whole, key: undefined };
    this.part = undefined;
  }

  /** Returns the numbers to plot over a range of time. They may be those of another body until the right ones are fetched. */
  numbers(of, range) {
    const part = range && this.part?.of === of && this.part.key === this.whole?.key && covers(this.part, this.frames(range)) ? this.part : undefined;
    return (part ?? (this.whole?.of === of ? this.whole : undefined))?.numbers;
  }

  /** Fetches what is missing for a plot of a quantity over a range of time. Returns true if that has changed anything. */
  async load({ of, body, key, range }) {
    const recorded = this.run.progress?.recorded ?? 0;
    const isNew = (known) => known?.key !== key || known.recorded !== recorded;
    let changed = false;
    if (isNew(this.whole)) {
      this.whole = { of, key, recorded, ...(await this.fetch(of, body, 0, this.run.frames)) };
      changed = true;
    }
    const wanted = range && this.finer(range);
    const isOld = () => this.part?.key !== key || (isNew(this.part) && this.part.recorded < this.part.to);
    if (wanted && (isOld() || !covers(this.part, this.frames(range)) || this.part.every >= 2 * wanted.every)) {
      this.part = { of, key, recorded, ...(await this.fetch(of, body, wanted.from, wanted.to)) };
      changed = true;
    }
    return changed;
  }

  /** Fetches every frame in a range of time. */
  async all({ of, body, range }) {
    const [from, to] = range ? this.frames(range) : [0, this.run.frames];
    return (await this.fetch(of, body, from, to, Infinity)).numbers;
  }

  async fetch(of, body, from, to, points = POINTS) {
    const every = stride(from, to, points);
    let numbers = new Float64Array();
    if (of === "balance") numbers = await this.run.balance(from, to, every);
    else if (body !== undefined) numbers = await this.run.series(body, from, to, every);
    return { from, to, every, numbers };
  }

  /** Returns the frames in a range of time, and one more at each end, so that curves reach the edges. */
  frames([from, to]) {
    const { run } = this;
    return [Math.max(0, Math.floor(run.positionAt(from)) - 1), Math.min(run.frames, Math.ceil(run.positionAt(to)) + 2)];
  }

  /** Returns the frames to fetch for a range of time and for half of it at each side. Undefined if the whole run is as fine. */
  finer(range) {
    const [first, end] = this.frames(range);
    const beside = Math.ceil((end - first) / 2);
    const [from, to] = [Math.max(0, first - beside), Math.min(this.run.frames, end + beside)];
    const every = stride(from, to);
    return every < this.whole.every ? { from, to, every } : undefined;
  }
}

const stride = (from, to, points = POINTS) => Math.max(1, Math.ceil((to - from) / points));
const covers = (part, [from, to]) => part.from <= from && part.to >= to;
