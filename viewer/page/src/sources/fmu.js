// FMUs that run in the tab, as a source of a page (see `Source` in shell/shell.js): connects the worker with the page.
import { heldVariables, outputNames } from "../live/engine.js";
import { between, Record } from "../live/record.js";
import { speedActions, unitsOf } from "./source_actions.js";
import { Blend } from "./blend.js";
import { clock, startWorker } from "../live/worker.js";

/** Delay of the picture behind the run, so that there is a row before and after it, s. */
const DELAY = 0.03;
/** Largest number of points of a curve. */
const MAX_POINTS = 1000;

/** Beginnings of error messages, by the action that failed. */
const ERROR_PREFIXES = { open: "The FMU could not be started: ", restart: "These values were refused: ", worker: "The FMU stopped: " };

/** A run in the worker, as a source. */
export class Session {
  grows = true;
  speeds = [0.02, 0.1, 0.25, 0.5, 1, 2, 5];

  /**
   * @param {Data[]} fmus `{description, wasm, resources, title}` with unpacked bytes
   * @param {Data} options `step`, `start`, `script` (inputs over time), `places` (start values by name)
   * @param {Data} listeners functions: started, refused, message, error, back, moved (another instant is to be shown), ran
   */
  constructor(fmus, options, listeners) {
    const descriptions = fmus.map((f) => f.description);
    this.step = options.step ?? descriptions[0].stepSize ?? 0.01;
    this.start = { ...options.start };
    this.prefixes = fmus.map((f, k) => (k ? `${f.title}: ` : ""));
    this.held = heldVariables(descriptions);
    this.outputs = descriptions.flatMap((d, k) => outputNames(d).map((name) => this.prefixes[k] + name));
    this.variables = new Map(descriptions.slice().reverse().flatMap((d) => d.variables.map((v) => [v.name, v])));
    this.running = false;
    this.speed = 1;
    this.pace = { at: 0, factor: null, slow: 0, cost: 0 };
    this.oldest = 0;
    this.scrubbed = null; // time of a picture earlier in the run, s; null: that of the run
    this._listeners = listeners;
    this._pending = new Map();
    const inputs = this.held.filter((v) => v.causality === "input").map((v) => v.name);
    const named = [...inputs, ...new Set(descriptions.flatMap((d) => outputNames(d)))];
    this.columns = unitsOf(named, (name) => this.variables.get(name)?.unit);
    this.fmus = fmus;
    this.acts = {
      ...speedActions(this, { speed: (factor) => (this.running ? this.run(factor) : (this.speed = factor)), back: (seconds) => this.rewind(seconds) }),
      toggle: () => (this.running ? this.pause() : this.run()),
      step: () => this.advance(),
      reset: () => this.again(),
      seek: (time) => this.scrub(time),
      stepSize: (step) => this.again(this._fitting(step), step).catch(() => {}), // reported by `error`
      ...(options.places ? { place: (name) => this.again({ ...this.start, ...options.places[name] }) } : {}),
    };
    this._newRecord();
    this._worker = startWorker((message) => this[`_on_${message.is}`](message));
    const parts = fmus.map(({ description, wasm, resources }) => ({ description, wasm, resources }));
    const { script } = options;
    this.ready = this._ask("started", { do: "open", fmus: parts, step: this.step, start: this.start, script });
  }

  /** Time of the last row, s. */
  get end() {
    return this.record.time;
  }

  /** @returns {[number, number]} */
  get range() {
    return [this.oldest, this.end];
  }

  /** Time of the picture, s: a little behind the run, and even by the clock. */
  get time() {
    if (this.scrubbed !== null) return this.scrubbed;
    if (!this.running) return this.end;
    const rate = this.pace.factor === null ? this.speed : Math.min(this.speed, this.pace.factor);
    const target = this._k * this.step + rate * (clock() - this.pace.at - DELAY);
    this._last = Math.max(this._last, Math.min(this.end, target));
    return this._last;
  }

  /** Run; from the shown instant if it is an earlier one. @param {number} [speed] simulated seconds per second */
  async run(speed = this.speed) {
    await this._leaveScrubbed();
    this.speed = speed;
    this.running = true;
    this._last = Math.min(this.end, this._last);
    this._worker.postMessage({ do: "run", speed });
    this._listeners.ran();
  }

  /** Goes back to the shown instant, if it is an earlier one. */
  async _leaveScrubbed() {
    if (this.scrubbed !== null) await this.back(Math.round(this.scrubbed / this.step));
  }

  /** Pauses the run. */
  pause() {
    this.running = false;
    return this._ask("paused", { do: "pause" });
  }

  /** Computes some communication steps, then pauses. @param {number} [count] */
  async advance(count = 1) {
    await this._leaveScrubbed();
    this.running = false;
    await this._ask("paused", { do: "step", count });
    this._listeners.moved();
  }

  /** Restart, with other start values or another communication step if they are given, and continues if it was running. */
  async again(start = this.start, step = this.step) {
    const { running } = this;
    Object.assign(this, { start: { ...start }, step, running: false, scrubbed: null });
    try {
      await this._ask("started", { do: "restart", start: this.start, step });
    } finally {
      if (running) await this.run();
      this._listeners.moved();
    }
  }

  /** Goes back, and continues if it was running. @param {number} seconds simulated time */
  async rewind(seconds) {
    const { running } = this;
    await this.back(Math.max(0, Math.round((this.time - seconds) / this.step)));
    if (running) await this.run();
    this._listeners.moved();
  }

  /** Start values whose inner step is not longer than a new communication step. @param {number} step s */
  _fitting(step) {
    const inner = this.variables.get("step_size");
    const { step_size: _, ...start } = this.start;
    return inner && step < Number(inner.start) ? { ...start, step_size: Math.max(step, inner.min ?? 0) } : start;
  }

  /** Goes back to step `k`; later rows are deleted. @param {number} k */
  async back(k) {
    this.running = false;
    this.scrubbed = null;
    await this._ask("back", { do: "back", k });
  }

  /** Pause, and show an earlier instant. @param {number} time s */
  scrub(time) {
    if (this.running) this.pause();
    this.scrubbed = Math.max(this.oldest, Math.min(time, this.end));
  }

  /** Passes on requests for inputs. @param {string} source @param {[string, number, number?][]} wants input, value, largest change per second */
  want(source, wants) {
    if (wants.length) this._worker.postMessage({ do: "want", wants });
  }

  /**
   * Sets an input or a parameter: a tunable one at once, a fixed one by a restart of the run.
   * @returns {Promise<boolean>} whether the run was restarted
   */
  async set(name, value) {
    const variable = this.variables.get(name);
    if (!variable) throw new Error(`The FMU has no variable '${name}'.`);
    if (this.held.some((v) => v.name === name)) {
      this.want("slider", [[name, Number(value)]]);
      return false;
    }
    await this.again({ ...this.start, [name]: value });
    return true;
  }

  /** The run as a table; see `Record.csv`. @returns {string[]} */
  csv() {
    const differing = Object.entries(this.start).filter(([name, value]) => value !== this.variables.get(name)?.start);
    const changed = differing.map(([name, value]) => `${name}=${typeof value === "string" ? `"${value}"` : value}`);
    const inputs = this.held.filter((v) => v.causality === "input").map((v) => v.name);
    const tuned = this.held.filter((v) => v.causality !== "input" && this._tuned.has(v.name)).map((v) => v.name);
    const { record } = this;
    const outputs = this.prefixes.length > 1 ? record.outputs : this.outputs;
    const comments = changed.length ? [`start: ${changed.join(", ")}`] : [];
    if (outputs.length) comments.push(`outputs from: ${outputs[0]}`);
    comments.push(`step: ${this.step}`);
    if (record.first > 0) comments.push(`the first ${record.first * this.step} s are not in this table`);
    return record.csv(comments, [...inputs, ...tuned], outputs);
  }

  /** Lookups of the numbers of each FMU at a time, NaN before the first row, then start values for fixed parameters. @param {number} [time] s */
  sample(time = this.time) {
    return this._bound.map(({ blend, columns, fixed }) => {
      if (this.record.end === 0) return () => NaN;
      const lookup = between(this.record, time, blend, columns);
      return (name) => (columns.has(name) ? lookup(name) : fixed.get(name));
    });
  }

  /** Finds the columns of the record for the variables of each FMU. */
  _bind() {
    this._bound = this.fmus.map(({ description: { variables }, scene }, k) => {
      /** @type {[string, number][]} */
      const outputColumns = variables.filter((v) => v.causality === "output").map((v) => [v.name, this.record.column(this.prefixes[k] + v.name)]);
      const columns = new Map([...this.held.map((v, i) => /** @type {[string, number]} */ ([v.name, i])), ...outputColumns.filter(([, index]) => index >= 0)]);
      const fixed = new Map(variables.filter((v) => !columns.has(v.name)).map((v) => [v.name, this.start[v.name] ?? v.start]));
      return { blend: new Blend(scene, variables), columns, fixed };
    });
  }

  /** Some columns of each FMU over the last seconds. @param {string[]} names @param {number} span s */
  plotted(names, span) {
    const { record } = this;
    const rows = Number.isFinite(span) ? Math.round(span / this.step) : record.end;
    const from = Math.max(record.first, record.end - rows);
    const stride = Math.max(1, Math.ceil((record.end - from) / MAX_POINTS));
    const [t] = record.series(0, from, stride); // one array for all curves, by which a diagram recognises that they share their times
    return this.prefixes.map((prefix, k) => {
      const at = (name) => record.column(prefix + name); // inputs and parameters have no prefix: they count to the first FMU
      const present = names.filter((name) => at(name) >= 0);
      const columns = Object.fromEntries(present.map((name) => [name, { unit: this.columns.get(name), data: record.series(at(name), from, stride)[1] }]));
      return { name: this.fmus[k].title, t, columns };
    });
  }

  /** Ends the worker. */
  close() {
    this._worker.terminate();
  }

  _newRecord() {
    this.record = new Record(this.held.map((v) => v.name), this.outputs, this.step);
    this._bind();
    this._tuned = new Set(); // parameters that were changed in the run
    this._k = 0;
    this._last = 0;
  }

  _ask(answer, message) {
    return new Promise((resolve, reject) => {
      this._pending.set(answer, [...(this._pending.get(answer) ?? []), { resolve, reject }]);
      this._worker.postMessage(message);
    });
  }

  _answer(answer, value) {
    const first = this._pending.get(answer)?.shift();
    first?.resolve(value);
  }

  _on_started({ step, held, outputs }) {
    this.step = step;
    this._newRecord();
    this.record.add(held, outputs);
    this.oldest = 0;
    this.pace = { at: clock(), factor: null, slow: 0, cost: this.pace.cost };
    this._listeners.started();
    this._answer("started");
  }

  _on_rows({ k, oldest, count, rows, pace }) {
    const [inputCount, width] = [this.held.length, this.held.length + this.outputs.length];
    for (let n = 0; n < count; n++) {
      const row = rows.subarray(n * width, (n + 1) * width);
      this._noteTuned(row);
      this.record.add(row.subarray(0, inputCount), row.subarray(inputCount));
    }
    this._k = k;
    this.oldest = Math.max(oldest * this.step, this.record.first * this.step);
    this.pace = pace;
  }

  _on_paused(message) {
    this._on_rows(message);
    this._answer("paused");
  }

  _on_back({ k }) {
    this._listeners.back();
    this.record.cut(k);
    this._k = k;
    this._last = this.end;
    this._answer("back");
  }

  _on_refused({ which, text, alive }) {
    if (!alive) this.running = false;
    this._listeners.refused(which, text, alive);
  }

  _on_message({ which, text, status }) {
    this._listeners.message(which, text, status);
  }

  _on_error({ at, text }) {
    this.running = false;
    const sentence = `${ERROR_PREFIXES[at] ?? ""}${text}`;
    const pending = [...this._pending.values()].flat();
    this._pending.clear();
    pending.forEach(({ reject }) => reject(new Error(sentence)));
    this._listeners.error(sentence);
  }

  /** Notes the tunable parameters that differ from the row before. */
  _noteTuned(row) {
    const before = this.record.row(this.record.end - 1);
    this.held.forEach((v, i) => {
      if (v.causality !== "input" && row[i] !== before[i]) this._tuned.add(v.name);
    });
  }
}
