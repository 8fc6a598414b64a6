// What a person does with the run: start, stop, go back, set values. Between the worker and everything that is seen.
import { Desk } from "./desk.js";
import { heldVariables, outputNames } from "./engine.js";
import { Record } from "./record.js";
import { clock } from "./worker.js";

/** The picture is this much behind the run, so that there is a row on either side of it, s. */
const BEHIND = 0.03;

/** A run as the page sees it. */
export class Session {
  /**
   * @param {Data[]} fmus - `{description, wasm, resources, title}` with unpacked bytes.
   * @param {Data} options - `step`, `start`, `script` (inputs over time), `worker`.
   * @param {Data} hears - Functions: started, refused, message, error.
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
    this._newRecord();
    this._desk = new Desk((message) => this._take(message), options);
    this.threaded = this._desk.threaded;
    const given = fmus.map(({ description, wasm, resources }) => ({ description, wasm, resources }));
    const { script } = options;
    this.ready = this._ask("started", { do: "open", fmus: given, step: this.step, start: this.start, script });
  }

  /** Time of the last row, s. */
  get time() {
    return this.record.time;
  }

  /** Time of the picture, s: a little behind the run, and evenly on by the clock. */
  get shown() {
    if (this.scrubbed !== null) return this.scrubbed;
    if (!this.running) return this.time;
    const rate = this.pace.factor === null ? this.speed : Math.min(this.speed, this.pace.factor);
    const wanted = this._k * this.step + rate * (clock() - this.pace.at - BEHIND);
    this._last = Math.max(this._last, Math.min(this.time, wanted));
    return this._last;
  }

  /** Let time run; from the instant that is shown if it is an earlier one. */
  async run(speed = this.speed) {
    if (this.scrubbed !== null) await this.back(Math.round(this.scrubbed / this.step));
    this.speed = speed;
    this.running = true;
    this._last = Math.min(this.time, this._last);
    this._desk.send({ do: "run", speed });
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
    return this._ask("paused", { do: "step", count });
  }

  /** Begin again, with other start values or another communication step where they are given. */
  restart(start = this.start, step = this.step) {
    this.start = { ...start };
    this.step = step;
    this.running = false;
    this.scrubbed = null;
    return this._ask("started", { do: "restart", start: this.start, step });
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
    this.scrubbed = Math.max(this.oldest, Math.min(time, this.time));
  }

  /** What a hand wants: `[name, value, rate]` each. */
  want(wants) {
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
      this.want([[name, Number(value)]]);
      return false;
    }
    const running = this.running;
    await this.restart({ ...this.start, [name]: value });
    if (running) await this.run();
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

  /** End it. */
  close() {
    this._desk.close();
  }

  _newRecord() {
    this.record = new Record(this.held.map((v) => v.name), this.outputs, this.step);
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
    const [held, width] = [this.held.length, this.held.length + this.outputs.length];
    for (let n = 0; n < count; n++) {
      const row = rows.subarray(n * width, (n + 1) * width);
      this._noteMoved(row);
      this.record.add(row.subarray(0, held), row.subarray(held));
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
    this.record.cut(k);
    this._k = k;
    this._last = this.time;
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
    const waiting = [...this._waiting.values()].flat();
    this._waiting.clear();
    waiting.forEach(({ reject }) => reject(new Error(text)));
    this._hears.error(at, text);
  }

  /** Which tunable parameters of a row are other than in the row before. */
  _noteMoved(row) {
    const before = this.record.row(this.record.end - 1);
    this.held.forEach((v, i) => {
      if (v.causality !== "input" && row[i] !== before[i]) this._moved.add(v.name);
    });
  }
}
