// The ratio of simulated to real time of a run.

/** Span over which simulated time is compared with the clock, s. */
const SPAN = 1.0;

/** Simulated seconds per second of the clock, over the last second. */
export class Factor {
  constructor() {
    this._marks = [];
  }

  /**
   * @param {{epoch?: number, running: boolean, speed: number, time: number, wall: number}} mark `time` of the run at the time
   *   `wall` of the clock, s; another epoch or speed begins again
   * @returns {number | null} null while it is too short to tell
   */
  add({ epoch = 0, running, speed, time, wall }) {
    const before = this._marks[this._marks.length - 1];
    if (!running || (before && (before.epoch !== epoch || before.speed !== speed))) this._marks = [];
    if (!running) return null;
    this._marks.push({ epoch, speed, time, wall });
    while (this._marks.length > 2 && wall - this._marks[1].wall >= SPAN) this._marks.shift();
    const [first] = this._marks;
    return wall - first.wall < 0.5 * SPAN ? null : (time - first.time) / (wall - first.wall);
  }
}
