// Holds a simulation to a clock by absolute deadlines: lateness is made up for, or reported if it cannot be.
import { Factor } from "../sources/factor.js";

/** Lag beyond which it is not made up for, s of the clock. */
const LAG_MOST = 0.25;

/** Steps that are due by a clock. */
export class RealTimeClock {
  /** @param {number} step - Communication step, s. */
  constructor(step) {
    this.step = step;
    this.speed = 1;
    this.running = false;
    this.slow = 0;
    this._factors = new Factor();
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
    this._factors = new Factor();
    this._mark(now, k);
    this.slow = 0;
  }

  /** Time stands. */
  stop() {
    this.running = false;
    this._factor = null;
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
    this._mark(now, k);
  }

  /** Simulated seconds per second of the clock over the last second; null while it is too short to tell. */
  factor() {
    return this._factor ?? null;
  }

  _mark(now, k) {
    this._factor = this._factors.add({ running: true, speed: this.speed, time: k * this.step, wall: now });
  }

  _anchor(now, k) {
    this._now = now;
    this._k = k;
  }
}
