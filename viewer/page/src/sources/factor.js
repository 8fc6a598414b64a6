// The ratio of simulated to real time of a run, and its text.
import { short } from "../common/dom.js";

/** Time over which simulated time is compared with the clock, s. */
const SPAN = 1.0;

/** Simulated seconds per second of the clock, over the last second. */
export class Factor {
  constructor() {
    this._samples = [];
  }

  /**
   * Adds a pair of times.
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

/** Ratio to the requested speed below which the machine is too slow. */
const SLOW_RATIO = 0.97;

/**
 * Text of the real-time factor, and a warning if the machine is too slow.
 * @param {{running: boolean, speed: number, factor: number | null}} pace `factor`: simulated seconds per second of the clock
 */
export function realTimeText({ running, speed, factor }) {
  const nominal = speed === 1 ? "real time" : speed < 1 ? `slow motion × ${short(speed)}` : `fast × ${short(speed)}`;
  if (!running) return { text: "paused", warn: "" };
  const late = factor !== null && factor < SLOW_RATIO * speed;
  const warn = late ? `This machine does not keep up: ${factor.toFixed(2)} s of the run a second, ${short(speed)} asked for.` : "";
  return { text: factor === null ? nominal : `${nominal} (× ${factor.toFixed(2)})`, warn };
}
