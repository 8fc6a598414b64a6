// The page of an FMU that runs in it: inputs by keys, gamepads, touch and sliders; pictures, plots and a record.
import { button, el, fixed, short } from "../common/dom.js";
import { DRIVING_WORDS } from "../common/key_table.js";
import { instead } from "../common/notices.js";
import { Shell } from "../shell/shell.js";
import { decodeContent } from "./content.js";
import { InputArbiter } from "./input_arbiter.js";
import { inputPanel, parameterPanel } from "./panel.js";
import { Session } from "../sources/fmu.js";
import { Stage } from "./stage.js";
import { levers } from "./touch.js";
import { missingParts } from "../common/browser_support.js";

const ACTS = ["steering", "throttle", "brake"];
const PLOTTED_NAMES = ["speed", "chassis.ay", "engine_speed", "motor_speed"];
const PANEL_MS = 100;
const RESTART_MS = 250;

/** The page of an FMU. */
export class Drive extends Shell {
  /**
   * @param {HTMLElement} container
   * @param {Data} given `fmus`: `{scene, description, wasm, resources, title}` of each, side by side; `beside`:
   *   recordings to be shown beside (viewer/page_data.py), `ends`: a sentence for the end of each; `script`: inputs
   *   over time, compressed JSON `{t, columns}`; `options`.
   */
  constructor(container, { options = {}, fmus, beside, ends = [], script }) {
    super(container, options);
    /** @type {Data} */
    this.options = options;
    this.quality = "auto";
    const missing = missingParts();
    if (missing) {
      instead(this.viewBox, "problem", missing);
      this.problem = missing;
      this.ready = Promise.reject(new Error(missing));
      this.ready.catch(() => {});
      return;
    }
    this.ready = this._open(fmus, { beside, ends, script });
    this.ready.catch((error) => this._wrong(error.message));
  }

  get views() {
    return this.stage?.parts.map(({ view }) => view) ?? [];
  }

  /** Time of the run, s. */
  get time() {
    return this.session.end;
  }

  /** Whether the run is running. */
  get running() {
    return this.session.running;
  }

  /** Real-time factor over the last second; null if unknown. */
  get factor() {
    return this.session.pace.factor;
  }

  /** Shows an earlier time, from which `run` continues. */
  seek(time) {
    this.session.scrub(time);
    this.draw();
  }

  /** Starts or continues the run. @param {number} [speed] simulated seconds per second of the clock */
  run(speed) {
    return this.session.run(speed);
  }

  /** Pauses the run. */
  pause() {
    return this.session.pause();
  }

  /** Makes communication steps, then pauses. */
  advance(count = 1) {
    return this.session.advance(count);
  }

  /** Restarts the run. */
  reset() {
    return this.session.again();
  }

  /** Goes back; a running run continues from there. @param {number} seconds of the run */
  back(seconds = 2) {
    return this.session.rewind(seconds);
  }

  /** Sets an input or parameter; a fixed one restarts the run. */
  async set(name, value) {
    if (this.inputs.some((v) => v.name === name)) {
      this.hands.hold(name);
      return this.session.want("slider", [[name, Number(value)]]);
    }
    const restarted = await this.session.set(name, value);
    if (restarted) this.tell(`The run began again with ${name} = ${value}.`);
    this.parameters?.show(name, value);
    return undefined;
  }

  /** The run as a table of inputs and outputs. */
  csv() {
    return this.session.csv().join("");
  }

  /** Last value of a signal of an FMU. */
  get(name, which = 0) {
    const column = this.session.record.column(this.session.prefixes[which] + name);
    const { record } = this.session;
    return record.row(record.end - 1)[column >= 0 ? column : record.column(name)];
  }

  /** Draws the current time. */
  draw() {
    const { session } = this;
    const { running, speed, step, pace } = session;
    this.stage.survey(session.range);
    this.stage.show(session.time, { running, speed, factor: pace.factor, cost: pace.cost, deadline: step / speed });
    this.stage.render();
    this._showPanel();
  }

  /** Removes everything from the page. */
  dispose() {
    this._ended = true;
    this.session?.close();
    this.stage?.dispose();
    super.dispose();
  }

  async _open(parts, { beside, ends, script }) {
    const { fmus, drawings, recordings, table } = await decodeContent(parts, { beside, ends, script });
    this.script = table;
    const pictures = drawings.map((drawing, k) => ({ ...drawing, sample: (time) => this.session.sample(time)[k] }));
    // No `await` before the listeners exist, so that the first answer is not lost.
    this.session = new Session(fmus, { ...this.options, script: table }, {
      started: () => this._started(),
      ran: () => this.notices.lower(["problem", "hidden"]),
      moved: () => this.draw(),
      back: () => this._clear(),
      refused: (which, text, alive) => this._refused(which, text, alive),
      message: (which, text) => this.tell(text),
      error: (text) => this._wrong(text),
    });
    this.stage = new Stage([...pictures, ...recordings], { look: this.look, notices: this.notices, box: this.viewBox });
    this._layOut(fmus[0]);
    this.stage.open();
    this.problem = this.stage.problem;
    this._controls();
    await this.session.ready;
    this.draw();
    this._drawn = NaN; // time of the last picture
    this._ran = false;
    const padPanel = this.driven(this.hands, this.inputs.map((v) => v.name));
    if (this.inputs.length) this.parameters.element.after(padPanel);
    this._frame();
    if (this.options.run !== false) await this.run();
  }

  _layOut(first) {
    const { session } = this;
    this.inputs = session.held.filter((v) => v.causality === "input");
    const names = this.inputs.map((v) => v.name);
    this.isCar = ACTS.every((name) => names.includes(name));
    const constants = [...session.variables.values()].filter((v) => v.variability === "constant");
    this.hands = new InputArbiter({
      inputs: names,
      constants: this.isCar ? Object.fromEntries(constants.map((v) => [v.name, Number(v.start)])) : null,
      want: (source, wants) => session.want(source, wants),
    });
    const want = (name, value) => {
      this.hands.hold(name);
      session.want("slider", [[name, value]]);
    };
    const follows = this.script ? `Inputs follow a table of ${short(this.script.t.at(-1))} s until a hand moves them. ` : "";
    const largest = (name) => Math.max(0, ...(this.script?.columns[name] ?? []).map(Math.abs));
    const sliders = this.inputs.map((v) => ({ ...v, largest: largest(v.name) }));
    this.inputPanel = inputPanel(sliders, want, follows + (this.isCar ? DRIVING_WORDS : ""));
    const settable = (v) => v.causality === "parameter" || (v.causality === "input" && v.variability === "fixed");
    const parameters = [...session.variables.values()].filter(settable);
    const roads = Object.keys(first.resources).filter((path) => path.startsWith("roads/")).map((path) => path.slice(6));
    this.parameters = parameterPanel(parameters, { set: (v, value) => this._setSoon(v, value), roads });
    this.sideBox.append(this.inputPanel.element, this.parameters.element);
    if (this.isCar) this.viewBox.append(levers(names, want));
  }

  _controls() {
    const { session } = this;
    const steps = stepChoices(session.step).map((h) => [h, `${Number((1e3 * h).toPrecision(6))} ms`]);
    for (const { holder } of this.stage.parts) this.watch(holder);
    for (const effect of ["arrows", "stress", "deformation", "closed"]) this.has[effect] = this.views.some((view) => view.has[effect]);
    this.cameras = this.view.cameraNames;
    this.cameraName = this.view.cameras?.name;
    const instruments = this.stage.parts.map((part) => part.instruments).filter(Boolean);
    const more = {
      csv: () => this._download(),
      costs: () => this.stage.parts.forEach(({ timing }) => timing.toggle()),
      ...(instruments.length ? { instruments: () => instruments.forEach((one) => one.toggle()) } : {}),
    };
    const driven = this.isCar ? (event) => this.hands.key(event, this.driverSpeed) : undefined;
    this.controls(session, more, { places: Object.keys(this.options.places ?? {}), steps, step: session.step }, driven);
    if (this.isCar && this.cameras.includes("chase")) this.camera("chase");
    const requested = this.options.plots ?? PLOTTED_NAMES.filter((name) => session.columns.has(name));
    const names = [...session.columns.keys()];
    const first = requested.length ? requested : names.slice(this.inputs.length, this.inputs.length + 3);
    this.plotted = first.slice(0, 4);
    this.side(true);
  }

  mute(on) {
    super.mute(on);
    this.stage.mute(on);
  }

  _setSoon(variable, value) {
    if (variable.variability === "tunable") {
      this.set(variable.name, value);
      return;
    }
    clearTimeout(this._soon);
    this._soon = setTimeout(() => this.set(variable.name, value).catch(() => {}), RESTART_MS);
  }

  _started() {
    this.stage.chooseRoads(this.session.start["road.file"] ?? "");
    this._clear(true);
    this.hands.clear();
  }

  _clear(begun = false) {
    this.stage.renew(begun);
    this.notices.lower();
  }

  _refused(which, text, alive) {
    const { title } = this.stage.parts[which];
    const choices = [button("begin again", "Begin again", () => this.reset()), button("go back", "2 s back", () => this.back())];
    const time = fixed(this.session.time, 3);
    const prefix = this.stage.parts.length > 1 ? `${title}: ` : "";
    this.notices.flag(`stopped ${which}`, `${prefix}Stopped at ${time} s. ${text}`, { bad: true, choices: alive ? [] : choices });
  }

  /** Shows a problem until the run continues. @param {string} sentence */
  _wrong(sentence) {
    this.notices.flag("problem", sentence, { bad: true });
  }

  get driverSpeed() {
    return this.get("speed");
  }

  sound() {
    this.stage.sound();
  }

  /** Pauses the run of a hidden page, with a notice. */
  unseen() {
    if (!this.session.running) return;
    this.pause();
    this.notices.flag("hidden", "Paused, because the page was not on the screen.");
  }

  _frame() {
    if (this._ended) return;
    requestAnimationFrame(() => this._frame());
    const { session } = this;
    const shown = session.time;
    if (shown !== this._drawn || session.running !== this._ran) {
      [this._drawn, this._ran] = [shown, session.running];
      this.draw();
    } else if (this.dirty) this.stage.render();
    this.dirty = false;
  }

  _showPanel() {
    const { session } = this;
    const now = performance.now();
    const { running, time } = session;
    this.bar.show(session);
    if (now - (this._panelTime ?? -Infinity) > PANEL_MS || !running) {
      this._panelTime = now;
      const row = session.record.row(Math.round(time / session.step));
      session.held.forEach((v, i) => (v.causality === "input" ? this.inputPanel : this.parameters).show(v.name, row[i]));
    }
    if (this.sideOpen) this.plots.now(!running);
  }

  _download() {
    const { record } = this.session;
    const begin = record.first * record.step;
    if (begin > 0) this.tell(`The table begins at ${short(begin)} s: what was before did not fit into the memory, so it cannot be repeated.`);
    const url = URL.createObjectURL(new Blob(this.session.csv(), { type: "text/csv" }));
    const name = (this.options.name ?? "run").replace(/[^\w.-]+/g, "_");
    const link = el("a", { href: url, download: `${name}.csv` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 60000);
  }
}

/** Selectable communication steps: that of the FMU, shorter and longer ones. */
function stepChoices(step) {
  return [0.1, 0.2, 0.5, 1, 2, 5].map((factor) => Number((factor * step).toPrecision(6)));
}
