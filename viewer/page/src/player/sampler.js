// Numbers of a run at any time: linear between samples, orientations along the shorter arc.

/**
 * Index of the last time that is not after t, and how far t is on the way to the next.
 * @param {ArrayLike<number>} times not decreasing
 * @param {number} t outside the times: their ends
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

/** @param {ArrayLike<number>} data @param {number} k @param {number} share of the way to sample k + 1 */
export function linear(data, k, share) {
  return share === 0 ? data[k] : data[k] + share * (data[k + 1] - data[k]);
}

/**
 * Between two orientations along the shorter arc; q and -q are the same one.
 * @param {number[]} a @param {number[]} b quaternions, of any length but zero
 * @param {number} share
 * @returns {number[]} unit quaternion
 */
export function slerp(a, b, share) {
  const p = normal(a);
  let q = normal(b);
  let cosine = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  if (cosine < 0) {
    q = q.map((x) => -x);
    cosine = -cosine;
  }
  const angle = Math.acos(Math.min(1, cosine));
  if (angle < 1e-6) return normal(p.map((x, i) => x + share * (q[i] - x)));
  const [first, second] = [Math.sin((1 - share) * angle), Math.sin(share * angle)];
  return normal(p.map((x, i) => first * x + second * q[i]));
}

function normal(q) {
  const size = Math.hypot(...q);
  return q.map((x) => x / size);
}

/** A run at an instant; `lookup` gives the numbers that the view asks for. */
export class Sampler {
  #k = 0;
  #share = 0;
  #turned = new Map();

  /** @param {{scene: Data | null, t: ArrayLike<number>, epoch: ArrayLike<number>, columns: import("./decode.js").Run["columns"]}} run */
  constructor(run) {
    this.run = run;
    /** Columns that are parts of a quaternion: [names of the four, which one]. */
    this.parts = new Map();
    for (const frame of Object.values(run.scene?.frames ?? {})) {
      frame.quaternion?.forEach((name, part) => this.parts.set(name, [frame.quaternion, part]));
    }
    this.lookup = (name) => this.#number(name);
    this.at(run.t[0]);
  }

  /** @param {number} t s */
  at(t) {
    const { t: times, epoch } = this.run;
    [this.#k, this.#share] = place(times, t);
    if (this.#share > 0 && epoch[this.#k] !== epoch[this.#k + 1]) this.#share = 0; // nothing moves from one epoch to the next
    this.#turned.clear();
  }

  /** Sample before the instant, and the share of the way to the next. @returns {[number, number]} */
  get place() {
    return [this.#k, this.#share];
  }

  #number(name) {
    const data = this.run.columns[name]?.data;
    if (data === undefined) return undefined;
    const quaternion = this.parts.get(name);
    if (quaternion === undefined || this.#share === 0) return linear(data, this.#k, this.#share);
    const [names, part] = quaternion;
    if (!this.#turned.has(names)) {
      const [a, b] = [this.#k, this.#k + 1].map((k) => names.map((other) => this.run.columns[other]?.data[k]));
      this.#turned.set(names, slerp(a, b, this.#share));
    }
    return this.#turned.get(names)[part];
  }
}
