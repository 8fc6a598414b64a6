// Received frames of the car, and the two between which a picture lies. Has no access to the page.

/** Frames are remembered for so long, s of the page's clock. */
const KEPT = 1.0;
/** The picture is never further behind than this, s. */
const MOST_DELAY = 0.2;
/** Largest change of the delay: up and down, s per second. */
const [RISE, FALL] = [0.4, 0.05];
/** Share of the frames that come in time at the delay that is chosen. */
const IN_TIME = 0.95;
/** Without a frame for so long while time runs, the picture stands and says so, s. */
const STALLED = 0.3;
/** A pace this near to the one asked for is that. */
const SAME_PACE = 0.05;

/**
 * The last frames, and the simulated time of the picture. The picture runs evenly by the page's clock, behind the newest
 * frame by a delay that is as small as the frames' jitter allows; nothing is extrapolated, and nothing stands between
 * frames of two epochs.
 */
export class Frames {
  constructor() {
    this._list = []; // {frame, now}, oldest first
    this._arrivals = [];
    this._shown = -Infinity;
    this._looked = -Infinity;
    /** The picture's delay, s. */
    this.delay = 0;
  }

  /** The newest frame, null before the first. */
  get newest() {
    return this._list.length ? this._list[this._list.length - 1].frame : null;
  }

  /**
   * A frame has come.
   * @param {Data} frame - As link.js gives it.
   * @param {number} now - Clock of the page, s.
   * @returns {boolean} Whether it begins a new epoch.
   */
  add(frame, now) {
    const before = this.newest;
    if (before && frame.epoch === before.epoch && frame.count < before.count) return false; // older than what is shown
    this._arrivals.push(now);
    while (now - this._arrivals[0] > KEPT) this._arrivals.shift();
    const restarted = before !== null && frame.epoch !== before.epoch;
    const same = before && !restarted && frame.running === before.running && frame.speed === before.speed;
    if (!same) {
      // Another pace: what was before tells nothing of what comes; within an epoch its last frame still begins the way.
      this._list = before && !restarted ? this._list.slice(-1) : [];
      this._paced = now;
    }
    if (restarted) this._shown = -Infinity;
    this._list.push({ frame, now });
    while (this._list.length > 2 && now - this._list[1].now > KEPT) this._list.shift();
    return restarted;
  }

  /** Frames of the last second. */
  get rate() {
    return this._arrivals.length;
  }

  /**
   * Where the picture stands.
   * @param {number} now - Clock of the page, s.
   * @returns {{before: Data, after: Data, share: number, time: number, stalled: number} | null} `stalled`: seconds
   *   without a frame, 0 while they come.
   */
  at(now) {
    if (!this._list.length) return null;
    const { frame: last, now: came } = this._list[this._list.length - 1];
    // A page that was busy itself has not heard what came meanwhile.
    const busy = Number.isFinite(this._looked) ? now - this._looked : 0;
    const quiet = last.running && now - came > STALLED + busy ? now - came : 0;
    const line = this._line();
    if (line) this._adapt(line, now);
    this._looked = now;
    const target = line ? line.best + line.pace * (now - this.delay) : last.time;
    this._shown = Math.max(Math.min(this._shown, last.time), Math.min(target, last.time));
    let k = this._list.length - 1;
    while (k > 0 && this._list[k - 1].frame.time >= this._shown) k -= 1;
    const after = this._list[k].frame;
    const before = this._list[Math.max(0, k - 1)].frame;
    const span = after.time - before.time;
    const share = span > 0 ? Math.max(0, Math.min(1, (this._shown - before.time) / span)) : 1;
    return { before, after, share, time: before.time + share * span, stalled: quiet };
  }

  /** The line over the page's clock on which the fastest frames lie; null where time stands or nothing is known. */
  _line() {
    const listed = this._list.filter(({ now }) => now >= this._paced);
    const last = listed[listed.length - 1];
    if (!last?.frame.running || listed.length < 2) return null;
    const [first] = listed;
    const asked = last.frame.speed;
    const span = last.now - first.now;
    let pace = span > KEPT / 3 ? (last.frame.time - first.frame.time) / span : asked;
    if (Math.abs(pace / asked - 1) < SAME_PACE) pace = asked;
    const leads = listed.map(({ frame, now }) => frame.time - pace * now);
    const best = Math.max(...leads);
    return { pace, best, leads, listed };
  }

  /** The delay follows how far behind the line the newest frame was just before the next one came. */
  _adapt({ pace, best, leads, listed }, now) {
    const short = [];
    for (let k = 1; k < listed.length; k++) {
      short.push((best - leads[k - 1]) / Math.max(pace, 1e-3) + (listed[k].now - listed[k - 1].now));
    }
    short.sort((a, b) => a - b);
    const delay = Math.min(MOST_DELAY, short[Math.min(short.length - 1, Math.floor(IN_TIME * short.length))]);
    if (!Number.isFinite(this._looked) || this.delay === 0) {
      this.delay = delay;
      return;
    }
    const passed = Math.min(0.1, Math.max(0, now - this._looked));
    this.delay += Math.max(-FALL * passed, Math.min(RISE * passed, delay - this.delay));
  }
}

/** How often something happened in the last second, and how unevenly. */
export class Beat {
  constructor() {
    this._times = [];
  }

  /** It happened. @param {number} now - s. */
  tick(now) {
    this._times.push(now);
    while (this._times.length > 2 && now - this._times[1] > 1) this._times.shift();
  }

  /** Times in the last second. */
  get rate() {
    const { length } = this._times;
    if (length < 2) return length;
    const span = this._times[length - 1] - this._times[0];
    return span > 0 ? (length - 1) / span : length;
  }

  /** The longest wait between two in the last second, s. */
  get longest() {
    return this._times.reduce((most, t, k) => (k ? Math.max(most, t - this._times[k - 1]) : most), 0);
  }
}
