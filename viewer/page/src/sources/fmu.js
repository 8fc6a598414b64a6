// FMUs that run in the tab, as a source of a page (see `Source` in shell/shell.js): between the worker and what is seen.
import { Desk } from "../live/desk.js";
import { heldVariables, outputNames } from "../live/engine.js";
import { between, Record } from "../live/record.js";
import { speedActions, unitsOf } from "./source_actions.js";
import { Blend, turnsOf } from "./blend.js";
import { clock } from "../live/worker.js";

/** The picture is this much behind the run, so that there is a row on either side of it, s. */
const BEHIND = 0.03;
/** Points of a curve. */
const MOST_POINTS = 1000;

/** What an answer begins with, by what was asked. */
const REFUSED = { open: "The FMU could not be started: ", restart: "These values were refused: ", worker: "The FMU stopped: " };

/** A run as the page sees it. */
export class Session {
  grows = true;
  speeds = [0.02, 0.1, 0.25, 0.5, 1, 2, 5];

  /**
   * @param {Data[]} fmus - `{description, wasm, resources, title}` with unpacked bytes.
   * @param {Data} options - `step`, `start`, `script` (inputs over time), `worker`, `places` (start values by name).
   * @param {Data} hears - Functions: started, refused, message, error, moved (another instant is to be shown), ran.
   */
  constructor(fmus, options, hears) {
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
    this.scrubbed = null; // time of the picture where it is not that of the run, s
    this._hears = hears;
    this._waiting = new Map();
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
      stepSize: (step) => this.again(this._fitting(step), step).catch(() => {}), // told by `error`
      ...(options.places ? { place: (name) => this.again({ ...this.start, ...options.places[name] }) } : {}),
    };
    this._newRecord();
    this._desk = new Desk((message) => this._take(message), options);
    this.threaded = this._desk.threaded;
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

  /** Time of the picture, s: a little behind the run, and evenly on by the clock. */
  get time() {
    if (this.scrubbed !== null) return this.scrubbed;
    if (!this.running) return this.end;
    const rate = this.pace.factor === null ? this.speed : Math.min(this.speed, this.pace.factor);
    const target = this._k * this.step + rate * (clock() - this.pace.at - BEHIND);
    this._last = Math.max(this._last, Math.min(this.end, target));
    return this._last;
  }

  /** Let time run; from the instant that is shown if it is an earlier one. */
  async run(speed = this.speed) {
    if (this.scrubbed !== null) await this.back(Math.round(this.scrubbed / this.step));
    this.speed = speed;
    this.running = true;
    this._last = Math.min(this.end, this._last);
    this._desk.send({ do: "run", speed });
    this._hears.ran();
  }

  /** Let time stand. */
  pause() {
    this.running = false;
    return this._ask("paused", { do: "pause" });
  }

  /** Some communication steps, then stand. */
  async advance(count = 1) {
    if (this.scrubbed !== null) await this.back(Math.round(this.scrubbed / this.step));
    this.running = false;
    await this._ask("paused", { do: "step", count });
    this._hears.moved();
  }

  /** Begin again, with other start values or another communication step where they are given, and run on if it ran. */
  async again(start = this.start, step = this.step) {
    const { running } = this;
    Object.assign(this, { start: { ...start }, step, running: false, scrubbed: null });
    try {
      await this._ask("started", { do: "restart", start: this.start, step });
    } finally {
      if (running) await this.run();
      this._hears.moved();
    }
  }

  /** Go back, and run on if it ran. @param {number} seconds - Of the run. */
  async rewind(seconds) {
    const { running } = this;
    await this.back(Math.max(0, Math.round((this.time - seconds) / this.step)));
    if (running) await this.run();
    this._hears.moved();
  }

  /** Start values with which an inner step is not longer than another communication step. */
  _fitting(step) {
    const inner = this.variables.get("step_size");
    const { step_size: _, ...start } = this.start;
    return inner && step < Number(inner.start) ? { ...start, step_size: Math.max(step, inner.min ?? 0) } : start;
  }

  /** Go back to a step that was; what came after it is forgotten. */
  async back(k) {
    this.running = false;
    this.scrubbed = null;
    await this._ask("back", { do: "back", k });
  }

  /** Show an earlier instant. */
  scrub(time) {
    if (this.running) this.pause();
    this.scrubbed = Math.max(this.oldest, Math.min(time, this.end));
  }

  /** What a hand wants. @param {string} source @param {[string, number, number?][]} wants */
  want(source, wants) {
    if (wants.length) this._desk.send({ do: "want", wants });
  }

  /**
   * Set an input, or a parameter: a tunable one at once, a fixed one begins the run again.
   * @returns {Promise<boolean>} Whether it began again.
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

  /** Values that the run began with, where they are not those of the FMU. */
  changed() {
    return Object.entries(this.start).filter(([name, value]) => value !== this.variables.get(name)?.start);
  }

  /** The run as a table; see `Record.csv`. @returns {string[]} */
  csv() {
    const changed = this.changed().map(([name, value]) => `${name}=${typeof value === "string" ? `"${value}"` : value}`);
    const inputs = this.held.filter((v) => v.causality === "input").map((v) => v.name);
    const tuned = this.held.filter((v) => v.causality !== "input" && this._moved.has(v.name)).map((v) => v.name);
    const { record } = this;
    const outputs = this.prefixes.length > 1 ? record.outputs : this.outputs;
    const comments = changed.length ? [`start: ${changed.join(", ")}`] : [];
    if (outputs.length) comments.push(`outputs from: ${outputs[0]}`);
    comments.push(`step: ${this.step}`);
    if (record.first > 0) comments.push(`the first ${record.first * this.step} s are not in this table`);
    return record.csv(comments, [...inputs, ...tuned], outputs);
  }

  /** Numbers of each FMU at a time; fixed parameters have the values of the start. @param {number} [time] - s. */
  sample(time = this.time) {
    return this._bound.map(({ blend, columns, fixed }) => {
      const lookup = between(this.record, time, blend, columns);
      return (name) => (columns.has(name) ? lookup(name) : fixed.get(name));
    });
  }

  /** Which columns of the record are those of each FMU. */
  _bind() {
    this._bound = this.fmus.map(({ description: { variables }, scene }, k) => {
      /** @type {[string, number][]} */
      const found = variables.filter((v) => v.causality === "output").map((v) => [v.name, this.record.column(this.prefixes[k] + v.name)]);
      const columns = new Map([...this.held.map((v, i) => /** @type {[string, number]} */ ([v.name, i])), ...found.filter(([, index]) => index >= 0)]);
      const fixed = new Map(variables.filter((v) => !columns.has(v.name)).map((v) => [v.name, this.start[v.name] ?? v.start]));
      return { blend: new Blend(turnsOf(scene)), columns, fixed };
    });
  }

  /** Some columns of each FMU over the last seconds. @param {string[]} names @param {number} span - s. */
  plotted(names, span) {
    const { record } = this;
    const rows = Number.isFinite(span) ? Math.round(span / this.step) : record.end;
    const from = Math.max(record.first, record.end - rows);
    const stride = Math.max(1, Math.ceil((record.end - from) / MOST_POINTS));
    const [t] = record.series(0, from, stride); // one list, which tells a diagram that its curves share their times
    return this.prefixes.map((prefix, k) => {
      const at = (name) => record.column(prefix + name); // what is set is in no FMU, or in the first
      const own = names.filter((name) => at(name) >= 0);
      const columns = Object.fromEntries(own.map((name) => [name, { unit: this.columns.get(name), data: record.series(at(name), from, stride)[1] }]));
      return { name: this.fmus[k].title, t, columns };
    });
  }

  /** End it. */
  close() {
    this._desk.close();
  }

  _newRecord() {
    this.record = new Record(this.held.map((v) => v.name), this.outputs, this.step);
    this._bind();
    this._moved = new Set(); // parameters that were changed in the run
    this._k = 0;
    this._last = 0;
  }

  _ask(answer, message) {
    return new Promise((resolve, reject) => {
      this._waiting.set(answer, [...(this._waiting.get(answer) ?? []), { resolve, reject }]);
      this._desk.send(message);
    });
  }

  _answer(answer, value) {
    const first = this._waiting.get(answer)?.shift();
    first?.resolve(value);
  }

  _take(message) {
    this[`_on_${message.is}`](message);
  }

  _on_started({ step, held, outputs }) {
    this.step = step;
    this._newRecord();
    this.record.add(held, outputs);
    this.oldest = 0;
    this.pace = { at: clock(), factor: null, slow: 0, cost: this.pace.cost };
    this._hears.started();
    this._answer("started");
  }

  _on_rows({ k, oldest, count, rows, pace }) {
    const [inputCount, width] = [this.held.length, this.held.length + this.outputs.length];
    for (let n = 0; n < count; n++) {
      const row = rows.subarray(n * width, (n + 1) * width);
      this._noteMoved(row);
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
    this._hears.back();
    this.record.cut(k);
    this._k = k;
    this._last = this.end;
    this._answer("back");
  }

  _on_refused({ which, text, alive }) {
    if (!alive) this.running = false;
    this._hears.refused(which, text, alive);
  }

  _on_message({ which, text, status }) {
    this._hears.message(which, text, status);
  }

  _on_error({ at, text }) {
    this.running = false;
    const sentence = `${REFUSED[at] ?? ""}${text}`;
    const waiting = [...this._waiting.values()].flat();
    this._waiting.clear();
    waiting.forEach(({ reject }) => reject(new Error(sentence)));
    this._hears.error(sentence);
  }

  /** Which tunable parameters of a row are other than in the row before. */
  _noteMoved(row) {
    const before = this.record.row(this.record.end - 1);
    this.held.forEach((v, i) => {
      if (v.causality !== "input" && row[i] !== before[i]) this._moved.add(v.name);
    });
  }
}
