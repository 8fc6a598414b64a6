// Runs that were recorded, as a source of a page; see `Source` in shell/shell.js.
import { speedActions, unitsOf } from "./source_actions.js";
import { Sampler } from "./sampler.js";

/** Speeds that can be chosen. */
const SPEEDS = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
/** Recorded times per step, without and with Shift. */
const STEPS = [1, 10];

/**
 * Names of all signals; those of positions and orientations of frames are last.
 * @param {Pick<import("./decode.js").Run, "scene" | "columns">[]} runs
 * @returns {string[]}
 */
export function signalNames(runs) {
  const poses = new Set();
  for (const { scene } of runs) {
    for (const frame of Object.values(scene?.frames ?? {})) {
      for (const name of [...(frame.position ?? []), ...(frame.quaternion ?? [])]) poses.add(name);
    }
  }
  const all = [...new Set(runs.flatMap(({ columns }) => Object.keys(columns)))];
  return [...all.filter((name) => !poses.has(name)), ...all.filter((name) => poses.has(name))];
}

/** Recordings shown at one common time, which can run and pause; slow drawing lowers the rate of pictures, not the pace. */
export class Recordings {
  speeds = SPEEDS;
  running = false;
  /** Called when another instant (true) or pace (false) is to be shown. @type {(moved: boolean) => Promise<void>} */
  changed = () => Promise.resolve();

  /** @param {import("./decode.js").Run[]} runs @param {{speed?: number, loop?: boolean, time?: number}} options */
  constructor(runs, { speed = 1, loop = true, time }) {
    this.runs = runs;
    this.speed = speed;
    /** Whether the run starts again at its end. */
    this.loop = loop;
    this.samplers = runs.map((run) => new Sampler(run));
    const [begin, end] = [Math.min(...runs.map(({ t }) => t[0])), Math.max(...runs.map(({ t }) => t[t.length - 1]))];
    /** @type {[number, number]} */
    this.range = [begin, end];
    this.time = this._limited(time ?? begin);
    this.columns = unitsOf(signalNames(runs), (name) => runs.find(({ columns }) => name in columns).columns[name].unit);
    const stepsOf = (/** @type {Data} */ event) => STEPS[event?.shiftKey ? 1 : 0];
    const toggle = () => this._pace(() => (this.running ? (this.running = false) : this._run()));
    const seek = (t) => this._seek(t);
    const pace = speedActions(this, {
      speed: (factor) => this._pace(() => (this.speed = Math.min(10, Math.max(0.05, factor)))),
      back: (seconds) => seek(this.time - seconds),
    });
    this.acts = {
      ...pace,
      toggle,
      play: toggle,
      seek,
      step: () => seek(this._recordedTime(STEPS[0])),
      before: (event) => seek(this._recordedTime(-stepsOf(event))),
      after: (event) => seek(this._recordedTime(stepsOf(event))),
      faster: () => pace.speed(this._nextSpeed(1)),
      slower: () => pace.speed(this._nextSpeed(-1)),
      reset: () => seek(begin),
      end: () => seek(end),
      loop: () => this._pace(() => (this.loop = !this.loop)),
    };
  }

  /** Advance the time. @param {number} passed s of the wall clock since the last picture */
  tick(passed) {
    if (!this.running) return;
    const [begin, end] = this.range;
    this.time += this.speed * passed;
    if (this.time < end) return;
    if (this.loop) this.time = begin + ((this.time - begin) % (end - begin));
    else [this.time, this.running] = [end, false];
  }

  /** Runs for diagrams. */
  plotted() {
    return this.runs;
  }

  /** Lookups of the numbers of each run. @param {number} [t] s @returns {import("../shell/shell.js").Lookup[]} */
  sample(t = this.time) {
    return this.samplers.map((sampler) => sampler.at(t));
  }

  /** The recorded time of the first run some steps after (negative: before) the shown one, s; pauses. @param {number} steps */
  _recordedTime(steps) {
    this.running = false;
    const { t } = this.runs[0];
    const [k, share] = this.samplers[0].place;
    const from = steps < 0 && share > 0 ? k + 1 : k;
    return t[Math.min(t.length - 1, Math.max(0, from + steps))];
  }

  _seek(t) {
    this.time = this._limited(t);
    return this.changed(true);
  }

  _run() {
    const [begin, end] = this.range;
    if (this.time >= end) this.time = begin;
    this.running = end > begin;
  }

  /** A time limited to the range of the runs; their begin if it is not finite. @param {number} t s */
  _limited(t) {
    const [begin, end] = this.range;
    return Math.min(end, Math.max(begin, Number.isFinite(t) ? t : begin));
  }

  _pace(change) {
    change();
    this.changed(false);
  }

  _nextSpeed(change) {
    const k = SPEEDS.findIndex((speed) => speed >= this.speed - 1e-9);
    const at = k < 0 ? SPEEDS.length - 1 : k;
    return SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at + change))];
  }
}
