// Received frames of the car, and the two between which a picture lies. Does not use the page.

/** Time for which frames are kept, s of the page's clock. */
const HISTORY = 1.0;
/** Largest delay of the picture, s. */
const MAX_DELAY = 0.2;
/** Largest rates at which the delay rises and falls, s per second. */
const [RISE, FALL] = [0.4, 0.05];
/** Share of the frames that arrive in time with the chosen delay. */
const IN_TIME_SHARE = 0.95;
/** Time without a frame, while the run is not paused, after which the picture counts as stalled, s. */
const STALL_TIME = 0.3;
/** Relative deviation from the requested pace up to which a measured pace is taken for it. */
const PACE_TOLERANCE = 0.05;

/**
 * The last frames, and the simulated time of the picture. The picture runs evenly by the page's clock, behind the newest
 * frame by a delay that is as small as the frames' jitter allows; nothing is extrapolated, and no picture lies
 * between frames of two epochs.
 */
export class Frames {
  constructor() {
    this._list = []; // {frame, now}, oldest first
    this._arrivals = [];
    this._shown = -Infinity;
    this._lastCall = -Infinity;
    /** The picture's delay, s. */
    this.delay = 0;
  }

  /** The newest frame; null before the first. */
  get newest() {
    return this._list.length ? this._list[this._list.length - 1].frame : null;
  }

  /**
   * Adds a received frame.
   * @param {Data} frame from link.js
   * @param {number} now clock of the page, s
   * @returns {boolean} whether it begins a new epoch
   */
  add(frame, now) {
    const before = this.newest;
    if (before && frame.epoch === before.epoch && frame.count < before.count) return false; // older than what is shown
    this._arrivals.push(now);
    while (now - this._arrivals[0] > HISTORY) this._arrivals.shift();
    const restarted = before !== null && frame.epoch !== before.epoch;
    const same = before && !restarted && frame.running === before.running && frame.speed === before.speed;
    if (!same) {
      // After a change of pace earlier frames do not count; within an epoch the last one still begins the interpolation.
      this._list = before && !restarted ? this._list.slice(-1) : [];
      this._paceSince = now;
    }
    if (restarted) this._shown = -Infinity;
    this._list.push({ frame, now });
    while (this._list.length > 2 && now - this._list[1].now > HISTORY) this._list.shift();
    return restarted;
  }

  /** Number of frames of the last second. */
  get rate() {
    return this._arrivals.length;
  }

  /**
   * The instant of the picture: the frames before and after it, the share of the way between them, and its time, s.
   * @param {number} now clock of the page, s
   * @returns {{before: Data, after: Data, share: number, time: number, stalled: number} | null} `stalled`: time
   *   without a frame, s; 0 while frames arrive.
   */
  at(now) {
    if (!this._list.length) return null;
    const { frame: last, now: came } = this._list[this._list.length - 1];
    // A page that was busy itself has not received the frames of that time.
    const busy = Number.isFinite(this._lastCall) ? now - this._lastCall : 0;
    const silence = last.running && now - came > STALL_TIME + busy ? now - came : 0;
    const line = this._line();
    if (line) this._adapt(line, now);
    this._lastCall = now;
    const target = line ? line.best + line.pace * (now - this.delay) : last.time;
    this._shown = Math.max(Math.min(this._shown, last.time), Math.min(target, last.time));
    let k = this._list.length - 1;
    while (k > 0 && this._list[k - 1].frame.time >= this._shown) k -= 1;
    const after = this._list[k].frame;
    const before = this._list[Math.max(0, k - 1)].frame;
    const span = after.time - before.time;
    const share = span > 0 ? Math.max(0, Math.min(1, (this._shown - before.time) / span)) : 1;
    return { before, after, share, time: before.time + share * span, stalled: silence };
  }

  /** Simulated time of the earliest frames as a line over the page's clock; null while paused or with one frame only. */
  _line() {
    const listed = this._list.filter(({ now }) => now >= this._paceSince);
    const last = listed[listed.length - 1];
    if (!last?.frame.running || listed.length < 2) return null;
    const [first] = listed;
    const requested = last.frame.speed;
    const span = last.now - first.now;
    let pace = span > HISTORY / 3 ? (last.frame.time - first.frame.time) / span : requested;
    if (Math.abs(pace / requested - 1) < PACE_TOLERANCE) pace = requested;
    const leads = listed.map(({ frame, now }) => frame.time - pace * now);
    const best = Math.max(...leads);
    return { pace, best, leads, listed };
  }

  /** Adapts the delay to how far the newest frame was behind the line just before the next one arrived. */
  _adapt({ pace, best, leads, listed }, now) {
    const delays = [];
    for (let k = 1; k < listed.length; k++) {
      delays.push((best - leads[k - 1]) / Math.max(pace, 1e-3) + (listed[k].now - listed[k - 1].now));
    }
    delays.sort((a, b) => a - b);
    const delay = Math.min(MAX_DELAY, delays[Math.min(delays.length - 1, Math.floor(IN_TIME_SHARE * delays.length))]);
    if (!Number.isFinite(this._lastCall) || this.delay === 0) {
      this.delay = delay;
      return;
    }
    const passed = Math.min(0.1, Math.max(0, now - this._lastCall));
    this.delay += Math.max(-FALL * passed, Math.min(RISE * passed, delay - this.delay));
  }
}

/** Rate and longest interval of events in the last second. */
export class Beat {
  constructor() {
    this._times = [];
  }

  /** Counts one event. @param {number} now s */
  tick(now) {
    this._times.push(now);
    while (this._times.length > 2 && now - this._times[1] > 1) this._times.shift();
  }

  /** Events per second. */
  get rate() {
    const { length } = this._times;
    if (length < 2) return length;
    const span = this._times[length - 1] - this._times[0];
    return span > 0 ? (length - 1) / span : length;
  }

  /** The longest interval between two events, s. */
  get longest() {
    return this._times.reduce((longest, t, k) => (k ? Math.max(longest, t - this._times[k - 1]) : longest), 0);
  }
}
