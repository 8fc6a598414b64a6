// The time that is shown: it runs and stands; where pictures take long there are fewer of them.

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
  }

  play() {
    if (this.end <= this.begin) return;
    if (this.time >= this.end) this.time = this.begin;
    this.playing = true;
  }

  pause() {
    this.playing = false;
  }

  /** @param {number} t s; held within the run */
  seek(t) {
    this.time = Math.min(this.end, Math.max(this.begin, Number.isFinite(t) ? t : this.begin));
  }

  /**
   * Let time pass.
   * @param {number} passed s of the wall clock since the last picture
   */
  tick(passed) {
    if (!this.playing) return;
    this.time += this.speed * passed;
    if (this.time < this.end) return;
    if (this.loop) this.time = this.begin + ((this.time - this.begin) % (this.end - this.begin));
    else {
      this.time = this.end;
      this.pause();
    }
  }
}

/** Speeds that can be chosen. */
export const SPEEDS = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
