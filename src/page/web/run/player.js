// Controls which frame is shown. While paused, the position is a whole frame. While playing, it may lie between two frames.

export class Player {
  constructor() {
    this.run = null;
    /** The position in the film, in frames. */
    this.position = 0;
    this.playing = false;
    this.speed = 1;
    this.loop = false;
  }

  get frame() {
    return Math.floor(this.position + 1e-9);
  }

  get time() {
    return this.run ? this.run.timeAt(this.position) : 0;
  }

  /** The index of the last frame that has been simulated. */
  get last() {
    return Math.max(0, (this.run?.progress?.recorded ?? 1) - 1);
  }

  /** The index of the last frame of the film. A run that has broken down ends early. */
  get end() {
    if (!this.run) return 0;
    return this.run.progress?.settled ? this.last : this.run.frames - 1;
  }

  seek(frame) {
    this.sought = undefined;
    this.position = Math.max(0, Math.min(Math.round(frame), this.end));
  }

  /** Returns to the first frame, and pauses. The space key does this, as in the physics-engine tutorial. */
  reset() {
    this.pause();
    this.sought = undefined;
    this.position = 0;
  }

  pause() {
    this.playing = false;
    this.position = this.frame;
  }

  play() {
    if (!this.run) return;
    this.sought = undefined;
    if (this.position >= this.end) this.position = 0;
    this.playing = true;
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  step(frames) {
    this.pause();
    this.seek(this.position + frames);
  }

  /** Advances the position by some seconds of real time. Waits if the next frame has not been fetched yet. */
  advance(seconds) {
    if (!this.playing || !this.run) return;
    let next = this.position + Math.min(seconds, 0.25) * this.speed * this.run.rate;
    const { end } = this;
    if (next >= end) {
      if (this.loop && this.last === end) next = end > 0 ? next % end : 0;
      else if (this.last === end) {
        this.position = end;
        this.playing = false;
        return;
      }
    }
    next = Math.min(next, this.last);
    if (this.run.poses(Math.floor(next)) || next < this.position) this.position = next;
  }

  /** Switches to another run, at the same time. */
  take(run) {
    // The new run may be shorter. The player then remembers the time, and returns to it when a longer run follows.
    const time = this.sought ?? this.time;
    this.run = run;
    const wanted = run.positionAt(time);
    const place = Math.min(wanted, run.frames - 1);
    this.position = this.playing ? place : Math.round(place);
    this.sought = wanted > run.frames - 1 ? time : undefined;
  }
}
