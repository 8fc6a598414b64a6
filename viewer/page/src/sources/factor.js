// The ratio of simulated to real time of a run.

/** Time over which simulated time is compared with the clock, s. */
const SPAN = 1.0;

/** Simulated seconds per second of the clock, over the last second. */
export class Factor {
  constructor() {
    this._samples = [];
  }

  /**
   * Add a pair of times.
   * @param {{epoch?: number, running: boolean, speed: number, time: number, wall: number}} mark simulated `time` and time
   *   `wall` of the clock, s; the comparison starts anew with another epoch or speed
   * @returns {number | null} null during the first half of the span, and while the run is paused
   */
  add({ epoch = 0, running, speed, time, wall }) {
    const previous = this._samples[this._samples.length - 1];
    if (!running || (previous && (previous.epoch !== epoch || previous.speed !== speed))) this._samples = [];
    if (!running) return null;
    this._samples.push({ epoch, speed, time, wall });
    while (this._samples.length > 2 && wall - this._samples[1].wall >= SPAN) this._samples.shift();
    const [first] = this._samples;
    return wall - first.wall < 0.5 * SPAN ? null : (time - first.time) / (wall - first.wall);
  }
}
