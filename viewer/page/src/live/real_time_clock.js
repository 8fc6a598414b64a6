// Synchronises a simulation with a clock by absolute deadlines; lateness is caught up, or reported.
import { Factor } from "../sources/factor.js";

/** Lateness above which steps are not caught up, s of the clock. */
const MAX_LAG = 0.25;

/** Computes the steps that are due by a clock. */
export class RealTimeClock {
  /** @param {number} step communication step, s */
  constructor(step) {
    this.step = step;
    this.speed = 1;
    this.running = false;
    this.slow = 0;
    /** Real-time factor over the last second; null at the start. @type {number | null} */
    this.factor = null;
    this._factors = new Factor();
  }

  /**
   * Starts the clock.
   * @param {number} now clock, s
   * @param {number} k number of completed steps
   * @param {number} speed simulated seconds per second of the clock
   */
  start(now, k, speed) {
    this.running = true;
    this.speed = speed;
    this._anchor(now, k);
    this._factors = new Factor();
    this._mark(now, k);
    this.slow = 0;
  }

  /** Stops the clock. */
  stop() {
    this.running = false;
    this.factor = null;
    this.slow = 0;
  }

  /** Number of steps that are due at a time of the clock, s. */
  due(now) {
    return this.running ? this._k + Math.floor(((now - this._now) * this.speed) / this.step + 1e-9) : 0;
  }

  /** Time of the clock at which step k is due, s. */
  deadline(k) {
    return this._now + ((k - this._k) * this.step) / this.speed;
  }

  /**
   * Reports completed steps. If they are too late, deadlines start again from here, which `slow` counts.
   * @param {number} now
   * @param {number} k number of completed steps
   */
  reached(now, k) {
    if (!this.running) return;
    if (now - this.deadline(k + 1) > MAX_LAG) {
      this._anchor(now, k);
      this.slow += 1;
    }
    this._mark(now, k);
  }

  _mark(now, k) {
    this.factor = this._factors.add({ running: true, speed: this.speed, time: k * this.step, wall: now });
  }

  _anchor(now, k) {
    this._now = now;
    this._k = k;
  }
}
