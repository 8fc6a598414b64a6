// The time that is shown: it runs, stands, and says when the machine cannot keep up.

const LONGEST_PICTURE = 0.1; // s; where a picture takes longer, the motion slows down instead of jumping
const SETTLED = 0.8; // s over which the rate is measured
const BEHIND = 0.9; // of the chosen speed

/** Runs from begin to end. */
export class Clock {
  /**
   * @param {number} begin @param {number} end s
   * @param {{speed?: number, loop?: boolean}} [options]
   */
  constructor(begin, end, { speed = 1, loop = true } = {}) {
    this.begin = begin;
    this.end = end;
    this.speed = speed;
    this.loop = loop;
    this.time = begin;
    this.playing = false;
    /** Time shown per time passed, measured while it plays; null before that is known. */
    this.rate = null;
    this.#measure();
  }

  play() {
    if (this.end <= this.begin) return;
    if (this.time >= this.end) this.time = this.begin;
    this.playing = true;
    this.#measure();
  }

  pause() {
    this.playing = false;
    this.rate = null;
  }

  /** @param {number} t s; held within the run */
  seek(t) {
    this.time = Math.min(this.end, Math.max(this.begin, Number.isFinite(t) ? t : this.begin));
  }

  /** @param {number} speed */
  faster(speed) {
    this.speed = speed;
    this.#measure();
  }

  /**
   * Let time pass.
   * @param {number} passed s of the wall clock since the last picture
   */
  tick(passed) {
    if (!this.playing) return;
    const step = this.speed * Math.min(passed, LONGEST_PICTURE);
    this.wall += passed;
    this.shown += step;
    if (this.wall > SETTLED) {
      this.rate = this.shown / this.wall;
      this.wall = this.shown = 0;
    }
    this.time += step;
    if (this.time < this.end) return;
    if (this.loop) this.time = this.begin + ((this.time - this.begin) % (this.end - this.begin));
    else {
      this.time = this.end;
      this.pause();
    }
  }

  /** Whether the motion is slower than it was chosen. */
  get behind() {
    return this.rate !== null && this.rate < BEHIND * this.speed;
  }

  #measure() {
    this.wall = this.shown = 0;
    this.rate = null;
  }
}

/** Speeds that can be chosen. */
export const SPEEDS = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
