// Runs the FMUs in a separate thread, so that drawing does not delay them; the page starts it from its own script.
import { loadFmu } from "../wasm/fmu.js";
import { Engine } from "./engine.js";
import { RealTimeClock } from "./real_time_clock.js";

/** Longest computation between messages of the page, s of the clock. */
const MAX_SLICE = 0.012;
/** Least interval of sending rows to the page, s of the clock. */
const POST_INTERVAL = 0.008;
/** Longest wait for the next step, ms. */
const WAKE_MS = 4;
/** Number of steps over which the cost of a step is averaged, and between two looks at messages of the FMUs. */
const [AVERAGED_STEPS, STEPS_PER_LOOK] = [200, 50];

// `currentScript` is defined only while the script of the page runs.
const pageScript = typeof document === "undefined" ? null : /** @type {HTMLScriptElement | null} */ (document.currentScript);

/** Time of a common clock of page and worker, s. */
export function clock() {
  return (performance.timeOrigin + performance.now()) / 1000;
}

/** Handles the messages of a page. */
export class Runner {
  /** @param {(message: Data, transfer?: ArrayBuffer[]) => void} post sends to the page */
  constructor(post) {
    this._post = post;
    this._timer = null;
    this._rows = [];
    this._posted = 0;
    this._cost = 0; // smoothed computing time of a step, s
    /** Reason why the FMUs did not start. @type {Data | null} */
    this._refused = null;
  }

  /** @param {Data} message `{do: "open" | "restart" | ..., ...}` */
  async take(message) {
    const begins = message.do === "open" || message.do === "restart";
    if (this._refused && !begins) {
      if (message.do !== "want") this._post(this._refused); // without a run there is no other answer
      return;
    }
    try {
      await this[`_${message.do}`](message);
      if (begins) this._refused = null;
    } catch (error) {
      const failure = { is: "error", at: message.do, text: String(error.message ?? error) };
      if (begins) this._refused = failure;
      this._halt();
      this._post(failure);
    }
  }

  async _open({ fmus, step, start, script }) {
    this._opened = { fmus, script };
    await this._load(step);
    await this._restart({ start, step });
  }

  async _load(step) {
    const { fmus, script } = this._opened;
    const loaded = [];
    for (const fmu of fmus) loaded.push(await loadFmu(fmu));
    this.engine = new Engine(loaded, step);
    this.engine.script = script ?? null;
  }

  async _restart({ start, step }) {
    this._halt();
    if (!this.engine || this.engine.fmus.some((fmu) => fmu.broken)) await this._load(step ?? this.engine.step);
    this.engine.step = step ?? this.engine.step;
    this.pacer = new RealTimeClock(this.engine.step);
    this._rows = [];
    this.engine.restart(start);
    this._postMessages();
    const { step: used, held, rows } = this.engine;
    this._post({ is: "started", step: used, held, outputs: rows.slice() });
  }

  _run({ speed }) {
    this.engine.retry();
    this.pacer.start(clock(), this.engine.k, speed);
    this._tick();
  }

  _pause() {
    this._halt();
    this._send("paused");
  }

  _step({ count }) {
    this._halt();
    this.engine.retry();
    for (let n = 0; n < count && this._makeStep(); n++);
    this._send("paused");
  }

  _want({ wants }) {
    for (const [name, value, rate] of wants) this.engine.want(name, value, rate);
  }

  _back({ k }) {
    this._halt();
    this._rows = [];
    this.engine.back(k);
    this._post({ is: "back", k: this.engine.k, held: this.engine.hand.values.slice() });
  }

  _halt() {
    clearTimeout(this._timer);
    this._timer = null;
    this.pacer?.stop();
  }

  /** Makes the steps that are due, and waits for the next. */
  _tick() {
    const begin = clock();
    const due = this.pacer.due(begin);
    let done = 0;
    let isRunning = true;
    let now = begin;
    while (isRunning && this.engine.k < due && now - begin < MAX_SLICE) {
      isRunning = this._makeStep();
      if (isRunning) done += 1;
      now = clock();
    }
    if (done) this._cost += ((now - begin) / done - this._cost) * Math.min(1, done / AVERAGED_STEPS);
    if (!isRunning) return;
    this.pacer.reached(now, this.engine.k);
    if (now - this._posted >= POST_INTERVAL) this._send("rows");
    const wait = 1000 * (this.pacer.deadline(this.engine.k + 1) - now);
    this._timer = setTimeout(() => this._tick(), Math.max(0, Math.min(WAKE_MS, wait)));
  }

  _makeStep() {
    const { engine } = this;
    const refused = engine.advance();
    if (engine.alive) this._rows.push(engine.held, engine.rows.slice());
    for (const { which, text } of refused) {
      if (!engine.alive) this._halt();
      this._send("rows");
      this._post({ is: "refused", which, text, k: engine.alive ? engine.k - 1 : engine.k, alive: engine.alive });
    }
    if (engine.k % STEPS_PER_LOOK === 0 || refused.length) this._postMessages(refused.length > 0);
    return engine.alive;
  }

  _postMessages(quiet = false) {
    const messages = this.engine.messages();
    if (!quiet) for (const { which, text, status } of messages) this._post({ is: "message", which, text, status });
  }

  _send(is) {
    const width = this.engine.heldNames.length + this.engine.rows.length;
    const count = this._rows.length / 2;
    const rows = new Float64Array(count * width);
    for (let n = 0; n < count; n++) {
      rows.set(this._rows[2 * n], n * width);
      rows.set(this._rows[2 * n + 1], n * width + this.engine.heldNames.length);
    }
    this._rows = [];
    this._posted = clock();
    const { k, oldest } = this.engine;
    const pace = { at: this._posted, factor: this.pacer.factor, slow: this.pacer.slow, cost: this._cost };
    this._post({ is, k, oldest, count, rows, pace }, [rows.buffer]);
  }
}

/** Starts to serve the page that started this worker. */
export function serve() {
  const runner = new Runner((message, transfer) => self.postMessage(message, { transfer: transfer ?? [] }));
  self.onmessage = (event) => runner.take(event.data);
}

/** Starts the worker of a page. @param {(message: Data) => void} take receives its messages @returns {Worker} */
export function startWorker(take) {
  const text = pageScript.src ? `importScripts(${JSON.stringify(pageScript.src)});` : pageScript.textContent;
  const url = URL.createObjectURL(new Blob([text, "\nALi3Viewer.serve();"], { type: "text/javascript" }));
  const worker = new Worker(url);
  URL.revokeObjectURL(url);
  worker.onmessage = (event) => take(event.data);
  worker.onerror = (event) => take({ is: "error", at: "worker", text: event.message || "it ended" });
  return worker;
}
