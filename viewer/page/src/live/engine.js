// Steps the FMUs of a page side by side with the same inputs, and saves states for rewinding; used in the worker.
import { place } from "../sources/sampler.js";
import { LimitedInputs } from "./input_rates.js";

/** Interval of saved states, s. */
const SAVE_INTERVAL = 0.25;
/** Longest time to go back, s. */
const MAX_REWIND = 30;

const NUMBER_TYPES = ["Real", "Integer", "Boolean"];

/** Inputs, then tunable parameters, of FMUs, each name once. */
export function heldVariables(descriptions) {
  const found = new Map();
  for (const { variables } of descriptions) {
    for (const v of variables) {
      const settable = v.causality === "input" || (v.causality === "parameter" && v.variability === "tunable");
      if (settable && NUMBER_TYPES.includes(v.type) && !found.has(v.name)) found.set(v.name, v);
    }
  }
  const all = [...found.values()];
  return [...all.filter((v) => v.causality === "input"), ...all.filter((v) => v.causality !== "input")];
}

/** Names of the numeric outputs of an FMU. */
export function outputNames({ variables }) {
  return variables.filter((v) => v.causality === "output" && /^(Real|Integer)$/.test(v.type)).map((v) => v.name);
}

/** Function that sets a variable of an instance. */
function writer(slave, { name, type }) {
  if (type === "Boolean") return (value) => slave.setBoolean(name, value !== 0);
  const write = slave.writer([name]);
  return (value) => write([value]);
}

/**
 * Inputs of a table at a time: interpolated linearly, integers held; of equal times the last row counts, and the table is
 * constant beyond its ends.
 * @param {{t: number[], columns: Object<string, number[]>}} script
 * @param {number} time s
 * @param {Set<string>} [whole] names of integers
 * @returns {Object<string, number>}
 */
export function scriptAt({ t, columns }, time, whole = new Set()) {
  const [k] = place(t, time + 1e-9);
  const next = Math.min(k + 1, t.length - 1);
  const s = next === k ? 1 : Math.max(time - t[k], 0) / (t[next] - t[k]);
  const found = {};
  for (const [name, values] of Object.entries(columns)) {
    const [a, b] = [values[k], values[next]];
    found[name] = s === 1 ? b : whole.has(name) ? a : a + s * (b - a);
  }
  return found;
}

/** The run of one or more FMUs. */
export class Engine {
  /** @param {Data[]} fmus of `loadFmu` @param {number} step communication step, s */
  constructor(fmus, step) {
    this.fmus = fmus;
    this.step = step;
    const descriptions = fmus.map((f) => ({ variables: [...f.variables.values()] }));
    const held = heldVariables(descriptions);
    this.heldNames = held.map((v) => v.name);
    this._whole = held.map((v) => v.type !== "Real");
    this._wholeNames = new Set(this.heldNames.filter((_, i) => this._whole[i]));
    this.outputs = descriptions.map(outputNames);
    this.rows = new Float64Array(this.outputs.reduce((sum, names) => sum + names.length, 0));
    this.script = null;
    this._requested = new Set();
    this.runs = [];
    this._states = []; // [k, state of each FMU, last inputs of each FMU], oldest first
  }

  /**
   * Restarts the run.
   * @param {Object<string, number|boolean|string>} start start values that differ from those of the FMUs, by name
   * @throws {Error} Message of the FMU; the old run has ended too.
   */
  restart(start) {
    this._freeStates();
    this.start = { ...(this.script ? scriptAt(this.script, 0, this._wholeNames) : {}), ...start };
    this.k = 0;
    this._requested.clear();
    this._past = new Map(); // inputs of step k, as far back as the states
    this.hand = new LimitedInputs(this.heldNames.map((name) => this._startOf(name)));
    if (!this.runs.length) this.runs = this._instances();
    else for (const run of this.runs) run.slave.reset();
    this.runs.forEach((run, which) => {
      const { variables } = this.fmus[which];
      const own = Object.entries(this.start).filter(([name]) => variables.has(name));
      run.slave.set(Object.fromEntries(own));
      run.slave.initialise({});
      run.failed = null;
      run.last.set(run.indices.map((i) => this.hand.values[i]));
    });
    this.held = this.hand.values.slice();
    this._read();
    this._save();
  }

  /** Time, s. */
  get time() {
    return this.k * this.step;
  }

  /** The oldest step to which one can go back. */
  get oldest() {
    return this._states.length ? this._states[0][0] : 0;
  }

  /** Whether any FMU has not failed. */
  get alive() {
    return this.runs.some((run) => run.failed === null);
  }

  /**
   * Makes a communication step of all FMUs that have not failed.
   * @returns {{which: number, text: string}[]} FMUs that failed in this step.
   */
  advance() {
    this._followScript();
    // The first step has the start values, so that a run with the same table of inputs is identical.
    const hand = this.k === 0 ? this.hand.values : this.hand.move(this.step);
    const values = hand.map((value, i) => (this._whole[i] ? Math.round(value) : value));
    this.held = values;
    const refused = this._stepWith(values);
    if (!this.alive) return refused; // a step in which all fail is not counted
    const before = this._past.get(this.k - 1);
    this._past.set(this.k, before && values.every((value, i) => Object.is(value, before[i])) ? before : values);
    this.k += 1;
    this._read();
    if (this.k % Math.max(1, Math.round(SAVE_INTERVAL / this.step)) === 0) this._save();
    return refused;
  }

  /**
   * Requests a value of an input or parameter, which then no longer follows the script.
   * @param {string} name
   * @param {number} value
   * @param {number} [rate] as for `LimitedInputs.want`
   */
  want(name, value, rate) {
    const index = this.heldNames.indexOf(name);
    if (index < 0) return;
    this._requested.add(name);
    this.hand.want(index, value, rate);
  }

  /** Goes back to an earlier step, with bitwise identical states. @param {number} k not before `oldest` */
  back(k) {
    const target = Math.max(this.oldest, Math.min(k, this.k));
    while (this._states.length > 1 && this._states[this._states.length - 1][0] > target) {
      this._states.pop()[1].forEach((s) => s?.free());
    }
    const [from, states, lastInputs] = this._states[this._states.length - 1];
    this.runs.forEach((run, i) => {
      if (states[i]) run.slave.setState(states[i]); // null: it had failed before
      run.last.set(lastInputs[i]);
      if (run.failed !== null && run.failed >= target) run.failed = null;
    });
    this.k = from;
    while (this.k < target) {
      const values = this._past.get(this.k);
      const failed = this.runs.filter((run) => run.failed !== null && run.failed <= this.k);
      this._stepWith(values, failed);
      this.k += 1;
      this.hand.hold(values);
    }
    for (const step of [...this._past.keys()]) if (step >= target) this._past.delete(step);
    if (target === from && this._past.has(from - 1)) this.hand.hold(this._past.get(from - 1));
    this._read();
  }

  /** Lets FMUs that failed in the last step repeat it with other inputs or parameters. */
  retry() {
    if (!this.alive) for (const run of this.runs) if (run.failed === this.k) run.failed = null;
  }

  /** Messages of the FMUs since the last call. */
  messages() {
    return this.runs.flatMap((run, which) => {
      // A page reads all outputs, so messages on those that are not computed are irrelevant.
      const relevant = run.slave.messages.filter((m) => m.category !== "logNotComputed");
      const found = relevant.map((m) => ({ which, ...m }));
      run.slave.messages.length = 0;
      return found;
    });
  }

  _stepWith(values, failed = this.runs.filter((run) => run.failed !== null)) {
    const refused = [];
    this.runs.forEach((run, which) => {
      if (failed.includes(run)) return;
      try {
        // Setting a variable may be expensive.
        run.indices.forEach((i, n) => {
          if (Object.is(run.last[n], values[i])) return;
          run.writers[n](values[i]);
          run.last[n] = values[i];
        });
        run.slave.step(this.step);
      } catch (error) {
        if (!error.status) throw error;
        run.failed = this.k;
        refused.push({ which, text: error.message, status: error.status });
      }
    });
    return refused;
  }

  /** Requests inputs of the script that were not requested otherwise. */
  _followScript() {
    if (!this.script) return;
    for (const [name, value] of Object.entries(scriptAt(this.script, this.time, this._wholeNames))) {
      if (!this._requested.has(name)) this.hand.want(this.heldNames.indexOf(name), value);
    }
  }

  _instances() {
    let begin = 0;
    return this.fmus.map((fmu, which) => {
      const slave = fmu.instantiate({});
      const names = this.heldNames.filter((name) => fmu.variables.has(name));
      const indices = names.map((name) => this.heldNames.indexOf(name));
      const writers = names.map((name) => writer(slave, fmu.variables.get(name)));
      const run = { slave, failed: null, begin, indices, writers, last: new Float64Array(names.length) };
      run.reader = slave.reader(this.outputs[which]);
      begin += this.outputs[which].length;
      return run;
    });
  }

  _freeStates() {
    for (const [, states] of this._states) states.forEach((s) => s?.free());
    this._states = [];
  }

  _read() {
    for (const run of this.runs) this.rows.set(run.reader(), run.begin);
  }

  _save() {
    const states = this.runs.map((run) => (run.failed === null ? run.slave.getState() : null));
    this._states.push([this.k, states, this.runs.map((run) => run.last.slice())]);
    while (this._states.length > 1 && this.k - this._states[1][0] >= MAX_REWIND / this.step) {
      this._states.shift()[1].forEach((s) => s?.free());
      for (const step of this._past.keys()) {
        if (step >= this.oldest - 1) break;
        this._past.delete(step);
      }
    }
  }

  _startOf(name) {
    if (name in this.start) return Number(this.start[name]);
    const v = this.fmus.map((f) => f.variables.get(name)).find(Boolean);
    return Number(v.start ?? 0);
  }
}
