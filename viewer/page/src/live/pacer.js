// Holds a simulation to a clock by absolute deadlines: what is late is made up for, what cannot be is told.

/** Lag beyond which it is not made up for, s of the clock. */
const LAG_MOST = 0.25;
/** Span over which the factor is measured, s of the clock. */
const SPAN = 1.0;

/** Steps that are due by a clock. */
export class Pacer {
  /** @param {number} step - Communication step, s. */
  constructor(step) {
    this.step = step;
    this.speed = 1;
    this.running = false;
    this.slow = 0;
    this._marks = [];
  }

  /**
   * Time runs from here.
   * @param {number} now - Clock, s.
   * @param {number} k - Steps that are done.
   * @param {number} speed - Simulated seconds per second of the clock.
   */
  start(now, k, speed) {
    this.running = true;
    this.speed = speed;
    this._anchor(now, k);
    this._marks = [[now, k]];
    this.slow = 0;
  }

  /** Time stands. */
  stop() {
    this.running = false;
    this._marks = [];
    this.slow = 0;
  }

  /** Steps that should be done at this time of the clock. */
  due(now) {
    return this.running ? this._k + Math.floor(((now - this._now) * this.speed) / this.step + 1e-9) : 0;
  }

  /** Time of the clock at which step k should be done. */
  deadline(k) {
    return this._now + ((k - this._k) * this.step) / this.speed;
  }

  /**
   * Tell how far the steps have come. If they are late by more than can be made up for, time runs on from here, and
   * `slow` counts it.
   * @param {number} now
   * @param {number} k - Steps that are done.
   */
  reached(now, k) {
    if (!this.running) return;
    if (now - this.deadline(k + 1) > LAG_MOST) {
      this._anchor(now, k);
      this.slow += 1;
    }
    this._marks.push([now, k]);
    while (this._marks.length > 2 && now - this._marks[1][0] >= SPAN) this._marks.shift();
  }

  /** Simulated seconds per second of the clock over the last second; null while it is too short to tell. */
  factor() {
    if (this._marks.length < 2) return null;
    const [t0, k0] = this._marks[0];
    const [t1, k1] = this._marks[this._marks.length - 1];
    return t1 - t0 < 0.5 * SPAN ? null : ((k1 - k0) * this.step) / (t1 - t0);
  }

  _anchor(now, k) {
    this._now = now;
    this._k = k;
  }
}
