// Numbers of a recorded run at any time.
import { Blend } from "./blend.js";

/**
 * Index of the last time that is not after t, and the share of the way from it to the next.
 * @param {ArrayLike<number>} times not decreasing
 * @param {number} t limited to the range of the times
 * @returns {[number, number]}
 */
export function place(times, t) {
  const last = times.length - 1;
  if (!(t > times[0])) return [0, 0];
  if (t >= times[last]) return [last, 0];
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return [low, (t - times[low]) / (times[high] - times[low])];
}

/** Interpolates linearly. @param {ArrayLike<number>} data @param {number} k @param {number} share of the way to sample k + 1 */
export function linear(data, k, share) {
  return share === 0 ? data[k] : data[k] + share * (data[k + 1] - data[k]);
}

/** Indices of at most `most` of `count` samples, evenly distributed, with the first and the last. @param {number} count @param {number} most */
export function spread(count, most) {
  const size = Math.min(count, most);
  return Array.from({ length: size }, (_, k) => (size > 1 ? Math.round((k * (count - 1)) / (size - 1)) : 0));
}

/** A run at an instant; `lookup` gives its numbers by name. */
export class Sampler {
  /** @type {(name: string) => number | undefined} */
  _now;

  /** @param {{scene: Data | null, t: ArrayLike<number>, epoch: ArrayLike<number>, columns: import("./decode.js").Run["columns"]}} run */
  constructor(run) {
    this.run = run;
    this._blend = new Blend(run.scene, Object.entries(run.columns).map(([name, { unit }]) => ({ name, unit })));
    this.lookup = (name) => this._now(name);
    this.at(run.t[0]);
  }

  /** Goes to a time. @param {number} t s @returns {import("../shell/shell.js").Lookup} `lookup`, which from now on gives the numbers of that time */
  at(t) {
    const { t: times, epoch, columns } = this.run;
    /** Sample before the instant, and the share of the way to the next. @type {[number, number]} */
    this.place = place(times, t);
    const [k, share] = this.place;
    if (share > 0 && epoch && epoch[k] !== epoch[k + 1]) this.place[1] = 0; // no interpolation between epochs
    const row = (i) => (name) => columns[name]?.data[i];
    this._now = this._blend.lookup(row(k), row(k + 1), this.place[1]);
    return this.lookup;
  }
}
