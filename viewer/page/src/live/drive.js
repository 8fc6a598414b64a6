// An FMU that runs in the page: it is driven by keys, gamepads, fingers and sliders, drawn, plotted and recorded.
import { button, el, short } from "../common/dom.js";
import { fullScreen } from "../common/full_screen.js";
import { Help } from "../common/help.js";
import { DRIVING_WORDS, hint } from "../common/key_table.js";
import { keys } from "../common/keys.js";
import { cameraActs } from "../common/views.js";
import { decoded } from "../sources/decode.js";
import { styled } from "../styles.js";
import { Bar } from "./bar.js";
import { BACK } from "./engine.js";
import { Hands, HANDS_MS } from "./hands.js";
import { gamepadPanel, inputPanel, parameterPanel, picturePanel } from "./panel.js";
import { Plots } from "./plots.js";
import { Session } from "./session.js";
import { Stage } from "./stage.js";
import style from "./style.css";
import { levers } from "./touch.js";
import { missingParts, unpack, unpackedJson } from "./unpack.js";

const ACTS = ["steering", "throttle", "brake"];
const PLOTTED = ["speed", "chassis.ay", "engine_speed", "motor_speed"];
const PLOT_MS = 120;
const PANEL_MS = 100;
const RESTART_MS = 250;

/**
 * Fill an element with an FMU that runs.
 * @param {HTMLElement} container
 * @param {Data} given - `{scene, description, wasm, resources, title}` of one FMU, or `fmus`: several of them side by
 *   side; `beside`: a page of recordings (viewer/page_data.py) that go along, `ends`: a sentence for the end of each;
 *   `script`: inputs over time, packed JSON `{t, columns}`; `options`.
 * @returns {Drive}
 */
export function drive(container, given) {
  return new Drive(container, given);
}

/** The page of an FMU. */
class Drive {
  /** @param {HTMLElement} container @param {Data} given - See `drive`. */
  constructor(container, { options = {}, fmus, beside, ends = [], script, ...one }) {
    /** @type {Data} */
    this.options = options;
    this.container = container;
    const parts = (fmus ?? [one]).map((f) => ({ ...f, title: f.title ?? f.description.modelName }));
    this.root = el("div.a3", { tabIndex: -1 });
    styled(style);
    container.append(this.root);
    const lacking = missingParts();
    if (lacking) {
      this.root.append(el("p.a3-notice", { data: "notice" }, lacking));
      this.problem = lacking;
      this.ready = Promise.reject(new Error(lacking));
      this.ready.catch(() => {});
      return;
    }
    this.ready = this._open(parts, { beside, ends, script });
    this.ready.catch((error) => this._tell(`${error.message}`));
  }

  /** The first picture. @returns {import("../scene/scene_view.js").SceneView} */
  get view() {
    return this.stage.parts[0].view;
  }

  /** Time of the run, s. */
  get time() {
    return this.session.time;
  }

  /** Whether time runs. */
  get running() {
    return this.session.running;
  }

  /** Simulated seconds per second of the clock over the last second, null if unknown. */
  get factor() {
    return this.session.pace.factor;
  }

  /** Show an instant that was; `run` drives on from there. */
  seek(time) {
    this.session.scrub(time);
    this.draw();
  }

  /** Choose a camera of all pictures. @returns {string} A sentence if there is none of this name. */
  camera(name) {
    if (!this.view.cameraNames.includes(name)) {
      return `There is no camera '${name}'; there are ${this.view.cameraNames.join(", ")}.`;
    }
    for (const part of this.stage.parts) if (part.view.cameraNames.includes(name)) part.view.camera(name);
    this.bar?.camera(name);
    this.stage.dirty = true;
    return "";
  }

  /** Let time run. @param {number} [speed] - Simulated seconds per second of the clock. */
  run(speed) {
    this._tell("");
    return this.session.run(speed);
  }

  /** Let time stand. */
  pause() {
    return this.session.pause();
  }

  /** Communication steps, then stand. */
  async advance(count = 1) {
    await this.session.advance(count);
    this.draw();
  }

  /** Begin again. */
  async reset() {
    const { running } = this.session;
    await this.session.restart();
    if (running) await this.session.run();
    this.draw();
  }

  /** Go back, and run on if it ran. @param {number} seconds - Of the run. */
  async back(seconds = 2) {
    const { session } = this;
    const { running } = session;
    await session.back(Math.max(0, Math.round((session.shown - seconds) / session.step)));
    this._clear();
    if (running) await session.run();
    this.draw();
  }

  /** Set an input or parameter; a fixed one begins the run again. */
  async set(name, value) {
    if (this.inputs.some((v) => v.name === name)) {
      this.hands.hold(name);
      return this.session.want([[name, Number(value)]]);
    }
    const restarted = await this.session.set(name, value);
    this._tell(restarted ? `The run began again with ${name} = ${value}.` : "", 3000);
    this.parameters?.show(name, value);
    if (restarted) this.draw();
    return undefined;
  }

  /** The run as a table of inputs and outputs. */
  csv() {
    return this.session.csv().join("");
  }

  /** Numbers of the run now, by name. */
  get(name, which = 0) {
    const column = this.session.record.column(this.session.prefixes[which] + name);
    const { record } = this.session;
    return record.row(record.end - 1)[column >= 0 ? column : record.column(name)];
  }

  /** Draw what is shown now. */
  draw() {
    const { session } = this;
    const { running, speed, step, pace } = session;
    this.stage.survey(session.record);
    this.stage.show(session.record, session.shown, { running, speed, step, factor: pace.factor, cost: pace.cost });
    this.stage.render();
    this._showPanel();
  }

  /** Take everything out of the page. */
  dispose() {
    this._ended = true;
    clearInterval(this._asking);
    this._listeners?.abort();
    this.session?.close();
    this.stage?.dispose();
    this.container.replaceChildren();
  }

  async _open(parts, { beside, ends, script }) {
    const runs = beside ? (await decoded(beside)).runs : [];
    const recordings = runs.map((run, k) => ({ title: `${run.name} (recorded)`, scene: run.scene, recording: { ...run, end: ends[k] } }));
    const table = script ? await unpackedJson(script) : null;
    this.script = table;
    const fmus = [];
    for (const part of parts) {
      const resources = {};
      for (const [path, packed] of Object.entries(part.resources ?? {})) resources[path] = await unpack(packed);
      fmus.push({ ...part, scene: await unpackedJson(part.scene), wasm: await unpack(part.wasm), resources });
    }
    const pictures = [];
    for (const { title, scene, roads, world: packed, description } of fmus) {
      const choices = roads ? await unpackedJson(roads) : {};
      const world = packed ? await unpackedJson(packed) : null;
      const drawn = world ? { ...scene, roads: choices[world.road], scenery: world.scenery } : scene;
      pictures.push({ title, scene: drawn, roads: choices, world, variables: new Map(description.variables.map((v) => [v.name, v])) });
    }
    // Nothing is awaited from here until the page hears: the first answer finds everything in its place.
    this.session = new Session(fmus, { ...this.options, script: table }, {
      started: () => this._started(),
      refused: (which, text, alive) => this._refused(which, text, alive),
      message: (which, text) => this._tell(text),
      error: (at, text) => this._error(at, text),
    });
    this.stage = new Stage([...pictures, ...recordings], { ...this.options.view, keep: this.options.keep }, (sentence) => this._tell(sentence));
    this._layOut(fmus[0]);
    this.stage.open();
    this.problem = this.stage.problem;
    this._cameras();
    await this.session.ready;
    this.plots.open();
    this.draw();
    this._drawn = NaN; // what the last picture showed
    this._ran = false;
    this._listen();
    this._asking = setInterval(() => this._poll(), HANDS_MS);
    this._frame();
    if (this.options.run !== false) await this.run(this.options.speed ?? 1);
  }

  _layOut(first) {
    const { session } = this;
    this.inputs = session.held.filter((v) => v.causality === "input");
    const names = this.inputs.map((v) => v.name);
    this.isCar = ACTS.every((name) => names.includes(name));
    const constants = [...session.variables.values()].filter((v) => v.variability === "constant");
    this.hands = new Hands({
      inputs: names,
      constants: this.isCar ? Object.fromEntries(constants.map((v) => [v.name, Number(v.start)])) : null,
      want: (source, wants) => session.want(wants),
    });
    const want = (name, value) => {
      this.hands.hold(name);
      session.want([[name, value]]);
    };
    const follows = this.script ? `Inputs follow a table of ${short(this.script.t.at(-1))} s until a hand moves them. ` : "";
    const largest = (name) => Math.max(0, ...(this.script?.columns[name] ?? []).map(Math.abs));
    const sliders = this.inputs.map((v) => ({ ...v, largest: largest(v.name) }));
    this.inputPanel = inputPanel(sliders, want, follows + (this.isCar ? DRIVING_WORDS : ""));
    const settable = (v) => v.causality === "parameter" || (v.causality === "input" && v.variability === "fixed");
    const parameters = [...session.variables.values()].filter(settable);
    const roads = Object.keys(first.resources).filter((path) => path.startsWith("roads/")).map((path) => path.slice(6));
    this.parameters = parameterPanel(parameters, { set: (v, value) => this._setSoon(v, value), roads });
    const plotted = [...names, ...new Set(session.outputs.map((name) => name.split(": ").at(-1)))];
    const wished = this.options.plots ?? PLOTTED.filter((name) => plotted.includes(name));
    const firstPlots = wished.length ? wished : plotted.slice(names.length, names.length + 3);
    this.plots = new Plots(plotted, session.variables, firstPlots.slice(0, 4));
    this.gamepadPanel = gamepadPanel(this.hands.gamepad, names);
    this.side = el("div.a3-side", {}, this.inputPanel.element, this.plots.element, this.parameters.element);
    if (names.length) this.side.append(this.gamepadPanel.element);
    this.banner = el("div.a3-banner", { data: "banner" });
    this.stage.element.append(this.banner);
    if (this.isCar) {
      this.stage.element.append(levers(names, want));
      this.root.classList.toggle("a3-touching", matchMedia("(pointer: coarse)").matches);
    }
    this.root.append(this.stage.element, this.side);
  }

  _cameras() {
    const { session } = this;
    const steps = stepChoices(session.step).map((h) => [h, `${Number((1e3 * h).toPrecision(6))} ms`]);
    const views = [];
    const flipLevers = () => this.root.classList.toggle("a3-touching");
    const has = this.stage.parts.map((part) => part.view.has ?? {});
    const shown = ["arrows", "stress", "closed"].filter((what) => has.some((one) => one[what]));
    if (this.isCar) {
      views.push({ data: "touch levers", text: "Levers", title: hint("levers"), work: flipLevers });
    }
    const act = {
      reset: () => this.reset(),
      toggle: () => (session.running ? this.pause() : this.run()),
      step: () => this.advance(),
      back: () => this.back(),
      rewind: ({ shiftKey }) => this.back(shiftKey ? 10 : 2),
      speed: (speed) => (session.running ? this.run(speed) : (session.speed = speed)),
      scrub: (time) => this.seek(time),
      camera: (name) => this.camera(name),
      stepSize: (step) => this._stepSize(step),
      csv: () => this._download(),
      place: (name) => this._place(name),
      slow: () => this.bar.slow(),
      panels: () => (this.side.hidden = !this.side.hidden),
      help: () => this.help.toggle(),
      close: () => this.help.toggle(false),
      "full screen": () => fullScreen(this.root),
      ...cameraActs({ names: () => this.view.cameraNames, all: this.view.cameraNames, now: () => this.view.cameras?.name, choose: (name) => this._tell(this.camera(name), 3000) }),
      ...(this.stage.parts.some(({ instruments }) => instruments) ? { instruments: () => this.stage.parts.forEach(({ instruments }) => instruments?.toggle()) } : {}),
      ...Object.fromEntries(shown.map((what) => [what, () => this._flip(what)])),
      ...(this.isCar ? { levers: flipLevers, mute: () => this._mute() } : {}),
    };
    this.act = act;
    const { places = {} } = this.options;
    this.bar = new Bar(act, { cameras: this.view.cameraNames, steps, step: session.step, views, places: Object.keys(places), sound: this.isCar });
    this.help = new Help(Object.keys(act), this.isCar);
    this.root.append(this.bar.element, this.help.element);
    const camera = this.options.camera ?? (this.isCar ? "chase" : "");
    if (this.view.cameraNames.includes(camera)) this.camera(camera);
    this.plots.element.before(picturePanel(has, (wishes) => this.stage.set(wishes), this.options.view?.quality));
  }

  /** @param {string} what is a switch of the picture */
  _flip(what) {
    /** @type {HTMLElement | null} */ (this.root.querySelector(`[data-a3="show ${what}"]`))?.click();
  }

  _mute() {
    this._muted = !this._muted;
    this.stage.mute(this._muted);
    this.bar.sound(this._muted ? "Sound off" : "Sound on");
  }

  /** Begin again at a place of the world. @param {string} name */
  async _place(name) {
    const { session } = this;
    const { running } = session;
    await session.restart({ ...session.start, ...this.options.places[name] });
    if (running) await session.run();
    this.draw();
  }

  /** Another communication step; the inner one is not longer than it. */
  async _stepSize(step) {
    const { session } = this;
    const { running } = session;
    const inner = session.variables.get("step_size");
    const start = { ...session.start };
    if (inner && step < Number(inner.start)) start.step_size = Math.max(step, inner.min ?? 0);
    else delete start.step_size;
    await session.restart(start, step).catch(() => {});
    if (running) await session.run();
    this.draw();
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
    this.stage.bind(this.session.record, this.session.prefixes, this.session.start);
    this.stage.chooseRoads(this.session.start["road.file"] ?? "");
    this._clear();
    this.hands.clear();
    this.plots.stale = true;
  }

  _clear() {
    this.stage.renew();
    for (const part of this.stage.parts) if (!part.view?.problem) this.stage.tell(part, "");
    this._tell("");
  }

  _refused(which, text, alive) {
    const part = this.stage.parts.filter((p) => p.variables)[which];
    const choices = [button("begin again", "Begin again", () => this.reset()), button("go back", "2 s back", () => this.back())];
    const time = this.session.time.toFixed(3);
    this.stage.tell(part, `Stopped at ${time} s. ${text}`, alive ? [] : choices);
  }

  _error(at, text) {
    const what = { open: "The FMU could not be started: ", restart: "These values were refused: " }[at] ?? "";
    this._tell(`${what}${text}`);
  }

  _tell(sentence, time = 0) {
    clearTimeout(this._banner);
    if (!this.banner) {
      if (sentence) this.root.append(el("p.a3-notice", { data: "notice" }, sentence));
      return;
    }
    this.banner.textContent = sentence;
    if (time) this._banner = setTimeout(() => (this.banner.textContent = ""), time);
  }

  _listen() {
    this._listeners = new AbortController();
    const { signal } = this._listeners;
    const { act } = this;
    const once = () => this.stage.sound();
    for (const event of ["keydown", "pointerdown"]) window.addEventListener(event, once, { signal, once: true });
    keys({ acts: act, signal, first: (event) => this.hands.key(event, this.get("speed")) });
    window.addEventListener("blur", () => this.hands.letKeysGo(), { signal });
    document.addEventListener("visibilitychange", () => this._hidden(), { signal });
  }

  /** A page that is not seen does not run: it says so when it is seen again. */
  _hidden() {
    if (!document.hidden || !this.session.running) return;
    this.pause();
    this._tell("Paused, because the page was not on the screen.");
  }

  _poll() {
    if (this.hands.poll(this.get("speed")).changed) this.gamepadPanel.fill();
    this.gamepadPanel.show();
  }

  _frame() {
    if (this._ended) return;
    requestAnimationFrame(() => this._frame());
    const { session } = this;
    const shown = session.shown;
    if (shown !== this._drawn || session.running !== this._ran) {
      [this._drawn, this._ran] = [shown, session.running];
      this.draw();
      return;
    }
    this.stage.render();
  }

  _showPanel() {
    const { session } = this;
    const now = performance.now();
    const { running, oldest, shown: time, scrubbed } = session;
    this.bar.show({ running, oldest, time, end: session.time, scrubbed: scrubbed !== null });
    if (now - (this._panelled ?? -Infinity) > PANEL_MS || !running) {
      this._panelled = now;
      const row = session.record.row(Math.round(time / session.step));
      session.held.forEach((v, i) => (v.causality === "input" ? this.inputPanel : this.parameters).show(v.name, row[i]));
    }
    if (now - (this._plotted ?? -Infinity) > PLOT_MS || !running || this.plots.stale) {
      this._plotted = now;
      this.plots.show(session.record, session.prefixes, time);
    }
  }

  _download() {
    const { record } = this.session;
    const begin = record.first * record.step;
    if (begin > 0) this._tell(`The table begins at ${short(begin)} s: what was before did not fit into the memory, so it cannot be repeated.`);
    const url = URL.createObjectURL(new Blob(this.session.csv(), { type: "text/csv" }));
    const name = (this.options.name ?? "run").replace(/[^\w.-]+/g, "_");
    const link = el("a", { href: url, download: `${name}.csv` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 60000);
  }
}

/** Communication steps to choose from: that of the FMU, shorter and longer ones. */
export function stepChoices(step) {
  return [0.1, 0.2, 0.5, 1, 2, 5].map((factor) => Number((factor * step).toPrecision(6)));
}

export { BACK };
