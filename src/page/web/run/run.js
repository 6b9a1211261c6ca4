// The data of a run that the page has fetched: its constant description, and frames within a memory budget.

import { isThere } from "../math.js";
import { binary, json } from "../source.js";

/** The largest size of the poses that are kept in memory, bytes. */
export const BUDGET = 256 << 20;
/** The size of the poses that are fetched together, bytes. */
const PIECE = 2 << 20;
/** The count of numbers in a pose: location (3) and orientation (4). */
const POSE = 7;
/** The number of frames for which the objects beside the bodies are fetched in advance. */
const AHEAD = 30;
/** The number of frames whose particles are fetched together, and the largest size of the particles kept in memory, bytes. */
const SWARMS = 10;
const SWARM_BUDGET = 64 << 20;
/** The count of numbers of a particle: location, end of its streak, radius, color, and whether it emits light. */
export const PARTICLE = 11;
const NOTHING = new Float64Array();

export class Run {
  constructor(id, description, forms) {
    /** The fonts of labels, each with the name of its family in style sheets. */
    this.fonts = [];
    this.id = id;
    this.description = description;
    this.forms = forms;
    this.bodies = description.bodies.length;
    this.frameBytes = Math.max(8, 8 * POSE * this.bodies);
    this.together = Math.max(1, Math.min(256, Math.floor(PIECE / this.frameBytes)));
    /** The fetched poses, in pieces by index. Each piece contains `frames` frames. */
    this.pieces = new Map();
    this.shown = new Map();
    /** The objects that were last drawn beside the bodies (`shown`), and the camera that saw them (`view`). */
    this.latest = undefined;
    /** The fetched particles, by frame. */
    this.swarms = new Map();
    this.swarmBytes = 0;
    this.ghosts = [];
    this.progress = null;
    this.closed = false;
    this.loading = null;
    this.changed = () => {};
  }

  /** Fetches the constant data of a run. */
  static async open(id) {
    const [description, forms] = await Promise.all([json(`/api/runs/${id}`), binary(`/api/runs/${id}/forms`)]);
    const run = new Run(id, description, readForms(forms));
    await run.loadFonts();
    return run;
  }

  /** Loads the fonts that labels have of their own. */
  async loadFonts() {
    const sizes = this.description.fonts;
    if (!sizes.length) return;
    const files = await binary(`/api/runs/${this.id}/fonts`);
    let end = 0;
    const load = (size, number) => {
      end += size;
      // A browser may refuse a font that POV-Ray reads. Its labels are then set in the usual font.
      return new FontFace(`label ${this.id} ${number}`, files.slice(end - size, end)).load().catch(() => null);
    };
    this.fonts = await Promise.all(sizes.map(load));
    this.fonts.filter(Boolean).forEach((font) => document.fonts.add(font));
  }

  get frames() {
    return this.description.frames;
  }

  get rate() {
    return this.description.frameRate;
  }

  /** Returns the simulated time (s) at a position of the film, in frames. */
  timeAt(position) {
    const { times } = this.description;
    if (!times.length) return position / this.rate;
    const before = Math.max(0, Math.min(Math.floor(position), times.length - 2));
    return times.length < 2 ? times[0] : times[before] + (position - before) * (times[before + 1] - times[before]);
  }

  /** Returns the position of the film, in frames, at a simulated time (s). It may lie beyond the last frame. */
  positionAt(time) {
    const { times } = this.description;
    if (!times.length) return time * this.rate;
    if (times.length < 2) return 0;
    let [before, after] = [0, times.length - 1];
    while (after - before > 1) {
      const middle = (before + after) >> 1;
      if (times[middle] <= time) before = middle;
      else after = middle;
    }
    return before + (time - times[before]) / (times[after] - times[before]);
  }

  /** Returns the frame nearest to a time, s. */
  frameAt(time) {
    return Math.max(0, Math.min(this.frames - 1, Math.round(this.positionAt(time))));
  }

  /** Stores the progress of the run. Returns true if the run has a new description, because it has finished. */
  async progressed(progress) {
    const settled = progress.settled && !this.progress?.settled;
    const isNew = progress.settled && !this.description.settled && !progress.problem;
    this.progress = progress;
    if (isNew) {
      this.description = await json(`/api/runs/${this.id}`);
      this.shown.clear();
    }
    if (settled && this.description.bodies.some((body) => body.ghosts)) {
      this.ghosts = await json(`/api/runs/${this.id}/ghosts`);
    }
    return isNew;
  }

  /** Returns the poses of all bodies in a frame: all locations, then all orientations. Undefined until they are fetched. */
  poses(frame) {
    if (!this.bodies) return frame < (this.progress?.recorded ?? 0) ? NOTHING : undefined;
    const piece = this.pieces.get(Math.floor(frame / this.together));
    const at = frame % this.together;
    if (!piece || at >= piece.frames) return undefined;
    piece.used = performance.now();
    return piece.numbers.subarray(at * POSE * this.bodies, (at + 1) * POSE * this.bodies);
  }

  /** Returns a function from the index of a body to its pose at a position of the film, interpolated between two frames if necessary. */
  posesAt(position) {
    const frame = Math.min(Math.floor(position + 1e-9), this.frames - 1);
    const from = this.poses(frame);
    if (!from) return undefined;
    const part = position - frame;
    const to = part > 1e-6 ? this.poses(frame + 1) : undefined;
    const turns = 3 * this.bodies;
    return (i) => {
      const [p, q] = [3 * i, turns + 4 * i];
      const here = [from[p], from[p + 1], from[p + 2], from[q], from[q + 1], from[q + 2], from[q + 3]];
      if (!to) return here;
      // A body that appears or disappears between the two frames keeps its pose until the second one.
      if (!isThere(here) || Number.isNaN(to[p])) return here;
      const then = [to[p], to[p + 1], to[p + 2], to[q], to[q + 1], to[q + 2], to[q + 3]];
      const sign = here[3] * then[3] + here[4] * then[4] + here[5] * then[5] + here[6] * then[6] < 0 ? -1 : 1;
      const mixed = here.map((a, k) => a + part * ((k < 3 ? 1 : sign) * then[k] - a));
      const norm = Math.hypot(mixed[3], mixed[4], mixed[5], mixed[6]) || 1;
      return mixed.map((a, k) => (k < 3 ? a : a / norm));
    };
  }

  /** Returns the pose of one body in a frame. */
  pose(body, frame) {
    const poses = this.poses(frame);
    if (!poses || !(body >= 0 && body < this.bodies)) return undefined;
    const turn = 3 * this.bodies + 4 * body;
    return {
      location: Array.from(poses.subarray(3 * body, 3 * body + 3)),
      orientation: Array.from(poses.subarray(turn, turn + 4)),
    };
  }

  /** Returns the objects drawn beside the bodies in a frame. Undefined until they are fetched. */
  shownIn(frame, view) {
    return this.shown.get(`${view} ${frame}`);
  }

  /** Returns the particles of a frame. Undefined until they are fetched. */
  particlesIn(frame) {
    return this.swarms.get(frame);
  }

  /** Fetches a frame, with the objects drawn beside the bodies. */
  async ready(frame, view) {
    const recorded = this.progress?.recorded ?? 0;
    if (frame < recorded && !this.poses(frame)) await this.fetchPoses(Math.floor(frame / this.together), recorded);
    if (frame < recorded && this.hasShown && !this.shownIn(frame, view)) await this.fetchShown(frame, view, recorded);
    if (frame < recorded && this.description.particles && !this.particlesIn(frame)) await this.fetchParticles(frame, recorded);
  }

  /** Fetches a frame, and then later frames as long as the memory budget allows. */
  async want(frame, view) {
    this.wanted = { frame, view };
    if (this.loading || this.closed) return;
    this.loading = this.load();
    try {
      await this.loading;
    } catch (error) {
      // The run has been replaced or the server has stopped. The page reports both elsewhere, so this function only waits before the next
      // attempt.
      await new Promise((resolve) => setTimeout(resolve, 500));
      this.changed();
    }
    this.loading = null;
  }

  /** True if the scene has objects beside the bodies, and the server can tell their positions. */
  get hasShown() {
    return this.description.shows && Boolean(this.description.stage);
  }

  async load() {
    for (;;) {
      if (this.closed) return;
      const { frame, view } = this.wanted;
      const recorded = this.progress?.recorded ?? 0;
      const unseen = this.hasShown ? this.firstWithout((next) => this.shownIn(next, view), frame, recorded) : undefined;
      const empty = this.description.particles ? this.firstWithout((next) => this.particlesIn(next), frame, recorded) : undefined;
      if (frame < recorded && !this.poses(frame)) {
        // The first frame is fetched without later ones, so that it is drawn sooner.
        const until = this.pieces.size ? recorded : frame + 1;
        await this.fetchPoses(Math.floor(frame / this.together), until);
      } else if (unseen !== undefined) {
        await this.fetchShown(unseen, view, recorded);
      } else if (empty !== undefined) {
        await this.fetchParticles(empty, recorded);
      } else {
        const next = this.next(frame, recorded);
        if (next === undefined) return;
        await this.fetchPoses(next, recorded);
      }
      this.changed();
    }
  }

  /** Returns the first of the next frames whose data is missing. `known` returns the data of a frame if it has been fetched. */
  firstWithout(known, frame, recorded) {
    const end = Math.min(frame + AHEAD, recorded);
    for (let next = frame; next < end; next++) if (!known(next)) return next;
    return undefined;
  }

  /** Returns the index of the next piece of poses to fetch in advance, from the present frame on. */
  next(frame, recorded) {
    if (!this.bodies) return undefined;
    const count = Math.ceil(recorded / this.together);
    const room = Math.max(2, Math.floor(BUDGET / (this.frameBytes * this.together)));
    const first = Math.floor(frame / this.together);
    for (let ahead = 0; ahead < Math.min(count, room - 1); ahead++) {
      const number = (first + ahead) % count;
      const there = Math.min(this.together, recorded - number * this.together);
      // A piece that is still growing is fetched only when it is needed or complete.
      const grows = there < this.together && !this.progress.settled;
      if (!grows && (this.pieces.get(number)?.frames ?? 0) < there) return number;
    }
    return undefined;
  }

  async fetchPoses(number, recorded) {
    const before = this.pieces.get(number);
    const first = number * this.together;
    const from = first + (before?.frames ?? 0);
    const to = Math.min(first + this.together, recorded);
    const more = new Float64Array(await binary(`/api/runs/${this.id}/poses`, { from, to }));
    const numbers = new Float64Array((before?.numbers.length ?? 0) + more.length);
    if (before) numbers.set(before.numbers);
    numbers.set(more, before?.numbers.length ?? 0);
    this.pieces.set(number, { numbers, frames: Math.floor((8 * numbers.length) / this.frameBytes), used: performance.now() });
    const room = Math.max(2, Math.floor(BUDGET / (this.frameBytes * this.together)));
    while (this.pieces.size > room) {
      const oldest = [...this.pieces].reduce((a, b) => (a[1].used < b[1].used ? a : b));
      this.pieces.delete(oldest[0]);
    }
  }

  async fetchShown(frame, view, recorded) {
    const many = Math.max(1, Math.min(40, Math.floor(4000 / this.bodies)));
    const to = Math.min(frame + many, recorded);
    const all = await json(`/api/runs/${this.id}/shown`, { from: frame, to, view });
    if (this.shown.size > 2000) this.shown.clear();
    all.forEach((shown, i) => this.shown.set(`${view} ${frame + i}`, shown));
  }

  async fetchParticles(frame, recorded) {
    const to = Math.min(frame + SWARMS, recorded);
    const numbers = new Float64Array(await binary(`/api/runs/${this.id}/particles`, { from: frame, to }));
    if (this.swarmBytes > SWARM_BUDGET) {
      this.swarms.clear();
      this.swarmBytes = 0;
    }
    this.swarmBytes += numbers.byteLength;
    let at = 0;
    for (let next = frame; next < to && at < numbers.length; next++) {
      const end = at + 1 + PARTICLE * numbers[at];
      this.swarms.set(next, numbers.subarray(at + 1, end));
      at = end;
    }
  }

  /** Fetches energies and momenta over some frames. Each frame has 13 numbers. */
  async balance(from, to, every = 1) {
    return new Float64Array(await binary(`/api/runs/${this.id}/balance`, { from, to, every }));
  }

  /** Fetches the motion of a body over some frames. Each frame has 15 numbers. */
  async series(body, from, to, every = 1) {
    return new Float64Array(await binary(`/api/runs/${this.id}/series`, { body, from, to, every }));
  }

  /** Fetches the contacts of a body in some frames. */
  async contacts(body, from, to, every = 1) {
    if (!this.description.contacts) return new Float64Array();
    return new Float64Array(await binary(`/api/runs/${this.id}/contacts`, { body, from, to, every }));
  }

  /** Releases the data of the run, which is no longer shown. */
  close() {
    this.fonts.filter(Boolean).forEach((font) => document.fonts.delete(font));
    this.closed = true;
    this.pieces.clear();
    this.shown.clear();
    this.swarms.clear();
  }
}

/** Reads the triangles of the base shapes. Each shape has its number of vertices and of indices, then positions, normals and indices. */
function readForms(buffer) {
  const view = new DataView(buffer);
  const forms = [];
  let at = 0;
  while (at < buffer.byteLength) {
    const vertices = view.getUint32(at, true);
    const indices = view.getUint32(at + 4, true);
    at += 8;
    const take = (Type, count) => {
      const array = new Type(buffer, at, count);
      at += 4 * count;
      return array;
    };
    forms.push({
      positions: take(Float32Array, 3 * vertices),
      normals: take(Float32Array, 3 * vertices),
      indices: take(Uint32Array, indices),
    });
  }
  return forms;
}
