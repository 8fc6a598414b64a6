// Plays recordings: the picture, the bar below it and the diagrams beside it, all at one time.
import looks from "../../../looks.json" with { type: "json" };
import { el } from "../common/dom.js";
import { fullScreen } from "../common/full_screen.js";
import { Help } from "../common/help.js";
import { keys } from "../common/keys.js";
import { Instruments } from "../instruments/index.js";
import { SceneView } from "../scene/scene_view.js";
import { styled } from "../styles.js";
import { Bar } from "./bar.js";
import { Clock } from "./clock.js";
import { playerActs } from "./keys.js";
import { fromHash, toHash } from "./link.js";
import { Plots } from "./plots.js";
import { extremesOf } from "./extremes.js";
import { Sampler } from "./sampler.js";
import { Settings } from "./settings.js";
import { Traces } from "./traces.js";
import style from "./style.css";

const WIDE = 1.15; // width over height from which the diagrams stand beside the picture
const SHOWN_NOTES = 3;
const SCANNED = 200; // times that ranges are looked for at
let count = 0;

/**
 * Show runs in an element.
 * @param {HTMLElement} container an element with a size
 * @param {{runs: import("./decode.js").Run[], options?: Data}} given the first run is drawn solid, others as ghosts
 * @returns {Player}
 */
export const play = (container, given) => new Player(container, given);

/** A page of recordings; `seek`, `camera`, `view` and `ready` are for programs. */
export class Player {
  /** @type {Plots | undefined} made when it is first shown */
  plots;
  /** @type {MediaQueryList | undefined} */
  dark;

  /** @param {HTMLElement} container @param {{runs: import("./decode.js").Run[], options?: Data}} given */
  constructor(container, { runs, options = {} }) {
    styled(style);
    this.id = count++;
    this.listeners = new AbortController();
    this.runs = runs;
    /** @type {Data} */
    this.options = { ...options, ...(options.controls === false ? {} : fromHash(location.hash)) };
    this.clock = new Clock(Math.min(...runs.map(({ t }) => t[0])), Math.max(...runs.map(({ t }) => t[t.length - 1])), {
      speed: this.options.speed ?? 1,
      loop: this.options.loop ?? true,
    });
    this.clock.seek(this.options.time ?? this.clock.begin);
    this.look = {
      arrows: this.options.arrows ?? false,
      arrowScale: this.options.arrow_scale ?? 1,
      stress: this.options.stress ?? false,
      deformation: this.options.deformation ?? 1,
      path: this.options.path ?? true,
      closed: this.options.closed ?? true,
    };
    this.samplers = runs.map((run) => new Sampler(run));
    this.themeName = this.options.theme ?? "auto";
    this.#build(container);
    this.#draw();
    if (this.options.controls !== false) this.#controls();
    else if (this.ghosts.length > 0) this.viewBox.append(el("div.ali3-head", {}, ...this.#names())); // pictures and films
    this.theme(this.themeName);
    document.addEventListener("visibilitychange", () => (this.last = undefined), { signal: this.listeners.signal }); // nobody has seen what passed
    this.observer = new ResizeObserver(() => this.#shape());
    this.observer.observe(this.root);
    this.#shape();
    this.#show();
    if (this.options.play) this.play();
    this.loopId = requestAnimationFrame((now) => this.#frame(now));
    /** Resolved when the first picture stands. */
    this.ready = this.#painted();
  }

  /** One sentence where nothing can be drawn, else empty. */
  get problem() {
    return this.view?.problem ?? "";
  }

  get time() {
    return this.clock.time;
  }

  /** Sentences on the runs: thinning, gaps. */
  get notes() {
    const several = this.runs.length > 1;
    return this.runs.flatMap(({ name, notes = [] }) => notes.map((note) => (several ? `${name}: ${note}` : note)));
  }

  get sideOpen() {
    return !this.sideBox?.hidden;
  }

  play() {
    this.clock.play();
    this.bar?.now();
  }

  pause() {
    this.clock.pause();
    this.bar?.now();
    this.remember();
  }

  toggle() {
    if (this.clock.playing) this.pause();
    else this.play();
  }

  /** @param {number} t s @returns {Promise<void>} when the picture stands on the screen */
  seek(t) {
    this.clock.seek(t);
    this.#show();
    this.changed();
    return this.#painted();
  }

  /** Go on by recorded times of the first run. @param {number} steps */
  step(steps) {
    this.clock.pause();
    const { t } = this.runs[0];
    const [k, share] = this.samplers[0].place;
    const from = steps < 0 && share > 0 ? k + 1 : k;
    const to = Math.min(t.length - 1, Math.max(0, from + steps));
    return this.seek(t[to]);
  }

  /** @param {number} speed from 0.05 to 10 */
  speed(speed) {
    this.clock.speed = Math.min(10, Math.max(0.05, speed));
    this.bar?.speeds(this.clock.speed);
    this.changed();
  }

  loop(on) {
    this.clock.loop = on;
    this.settings?.refresh({ loop: on });
  }

  /** @param {string} name @returns {string} a sentence if there is no such camera, else empty */
  camera(name) {
    if (!this.cameras.includes(name)) return `There is no camera '${name}'; there are ${this.cameras.join(", ") || "none"}.`;
    this.view.camera(name);
    this.cameraName = name;
    if (this.bar?.camera) this.bar.camera.value = name;
    this.dirty = true;
    this.changed();
    return "";
  }

  /** @param {{arrows?: boolean, arrowScale?: number, stress?: boolean, deformation?: number, path?: boolean, closed?: boolean}} look */
  set(look) {
    if (look.stress && this.look.closed && look.closed === undefined && this.has.closed) look.closed = false; // what has the colours is within
    Object.assign(this.look, look);
    this.view?.set?.(look);
    if (look.deformation !== undefined && this.solid >= 0) {
      this.#scan(); // the floor lies below what is drawn
      this.#show();
    }
    if (look.path !== undefined) for (const { traces } of this.drawnRuns) traces.show(look.path);
    this.settings?.refresh(look);
    this.dirty = true;
  }

  /** @param {Data} ghost @param {boolean} on */
  showGhost(ghost, on) {
    if (on) ghost.drawn ??= this.view.addGhost(ghost.run.scene, ghost.options);
    else {
      ghost.drawn?.remove();
      ghost.drawn = undefined;
    }
    this.drawnRuns.find(({ sampler }) => sampler === ghost.sampler)?.traces.show(on && this.look.path);
    this.#show();
  }

  /** Show or hide the diagrams. @param {boolean} open */
  side(open) {
    this.sideBox.hidden = !open;
    this.plots ??= new Plots(this.sideBox, this, this.options.plots ?? []);
    this.bar.signals.setAttribute("aria-pressed", String(open));
    this.#shape();
    this.plots.resize();
    this.dirty = true;
  }

  /** @param {"auto" | "light" | "dark"} name */
  theme(name) {
    this.themeName = name;
    this.dark ??= matchMedia("(prefers-color-scheme: dark)");
    this.dark.onchange = () => this.theme(this.themeName);
    this.root.dataset.theme = name === "auto" ? (this.dark.matches ? "dark" : "light") : name;
    this.plots?.redraw();
  }

  fullScreen() {
    fullScreen(this.root);
  }

  /** Something that the address of the page tells has changed. */
  changed() {
    if (!this.clock.playing) this.remember();
  }

  /** Write into the address what is shown, so that it can be sent to somebody. */
  remember() {
    if (this.options.controls === false || !/^(https?|file):$/.test(location.protocol)) return;
    clearTimeout(this.later);
    const state = { time: this.clock.time, camera: this.cameraName === this.cameras[0] ? "" : this.cameraName, plots: this.plots?.chosen ?? [], speed: this.clock.speed };
    this.later = setTimeout(() => history.replaceState(null, "", toHash(state)), 150); // browsers allow few a second
  }

  dispose() {
    this.listeners.abort();
    cancelAnimationFrame(this.loopId);
    clearTimeout(this.later);
    this.observer.disconnect();
    this.plots?.dispose();
    for (const { traces } of this.drawnRuns) traces.dispose();
    this.view?.dispose();
    this.dark.onchange = null;
    this.root.remove();
  }

  #build(container) {
    this.viewBox = el("div.ali3-view");
    this.sideBox = el("aside.ali3-side", { hidden: true, "aria-label": "signals" });
    this.stage = el("div.ali3-stage", {}, this.viewBox, this.sideBox);
    this.foot = el("div.ali3-foot");
    this.root = el("div.ali3-player", { tabIndex: -1 }, this.stage, this.foot);
    container.replaceChildren(this.root);
  }

  /** The picture: of the first run that has a scene; the other runs are ghosts. */
  #draw() {
    this.solid = this.runs.findIndex(({ scene }) => scene !== null && scene !== undefined);
    this.ghosts = [];
    this.cameras = [];
    /** @type {{traces: Traces, sampler: Sampler}[]} */
    this.drawnRuns = [];
    this.has = {};
    if (this.solid < 0) return;
    const { scene } = this.runs[this.solid];
    this.view = new SceneView(this.viewBox, scene, { words: this.options.controls !== false, keep: this.options.controls === false, driven: this.options.controls !== false, quality: this.options.quality });
    this.view.set?.(this.look);
    this.#scan();
    const has = this.view.has ?? { arrows: scene.arrows?.length > 0, stress: scene.flexible?.some(({ stress }) => stress), deformation: scene.flexible?.length > 0 };
    this.#trace(this.solid);
    for (const [k, run] of this.runs.entries()) {
      if (k === this.solid || !run.scene || this.problem) continue;
      const options = { name: run.name, tint: looks.ghosts[this.ghosts.length % looks.ghosts.length] };
      this.ghosts.push({ name: run.name, run, options, sampler: this.samplers[k], drawn: this.view.addGhost(run.scene, options) });
      this.#lower(run, this.ghosts.at(-1).drawn);
      this.#trace(k, { tint: options.tint, under: this.ghosts.length });
    }
    const { way } = this.drawnRuns[0].traces;
    if (way.length > 0) this.view.stand(way);
    this.has = { ...has, path: this.drawnRuns.some(({ traces }) => traces.paths.length > 0) };
    this.cameras = this.view.cameraNames;
    this.cameraName = this.cameras[0];
    if (this.options.camera !== undefined) this.wrong = this.camera(this.options.camera);
    for (const event of ["pointerdown", "pointermove", "wheel", "touchmove", "pointerup"]) {
      this.viewBox.addEventListener(event, () => (this.dirty = true), { passive: true });
    }
  }

  /** What a run leaves on the ground. @param {number} k of the run @param {{tint: string, under: number}} [ghost] */
  #trace(k, ghost) {
    const traces = new Traces(this.view, this.runs[k], ghost);
    traces.show(this.look.path);
    this.drawnRuns.push({ traces, sampler: this.samplers[k] });
  }

  /** Lets the view look through the run, so that floor, arrows and colours keep one scale. */
  #scan() {
    const { t, columns } = this.runs[this.solid];
    const times = Math.min(t.length, SCANNED);
    const sample = (i) => (times > 1 ? Math.round((i * (t.length - 1)) / (times - 1)) : 0);
    this.view.scan?.((i) => (name) => columns[name]?.data[sample(i)], times);
    this.#lower(this.runs[this.solid], this.view);
    for (const { run, drawn } of this.ghosts) this.#lower(run, drawn);
  }

  /** Puts the floor below a run where its columns are largest and smallest. @param {import("./decode.js").Run} run @param {Data} drawn */
  #lower(run, drawn) {
    if (this.problem || (this.runs[this.solid].scene.roads ?? []).length > 0) return; // roads are the floor
    const instants = extremesOf(run);
    drawn?.lower((i) => (name) => run.columns[name]?.data[instants[i]], instants.length);
  }

  #controls() {
    this.#head();
    const { scene, columns = {} } = this.runs[this.solid] ?? {};
    const names = new Set(Object.keys(columns));
    if (!this.problem && Instruments.of(names)) {
      this.instruments = new Instruments(names, { scene });
      this.viewBox.append(this.instruments.layer());
    }
    this.barBox = el("div.ali3-bar");
    this.foot.append(this.barBox);
    this.bar = new Bar(this.barBox, this);
    if (this.bar.camera) this.bar.camera.value = this.cameraName;
    this.settings = new Settings(this.foot, this);
    const plotsOnly = this.solid < 0;
    if (plotsOnly) this.root.dataset.plotsOnly = "yes";
    if (plotsOnly || this.options.plots?.length) this.side(true);
    const acts = playerActs(this);
    this.help = new Help(Object.keys(acts));
    this.root.append(this.help.element);
    keys({ acts, signal: this.listeners.signal });
  }

  /** Names of the runs with the colours of their paths. */
  #names() {
    return this.runs.map((run, k) => {
      const ghost = this.ghosts.find((other) => other.run === run);
      const colour = ghost?.options.tint ?? (k === this.solid && this.ghosts.length > 0 ? looks.paths.body : undefined);
      const swatch = colour ? [el("span.ali3-swatch", { style: `background:${colour}` })] : [];
      return el("div.ali3-name", {}, ...swatch, run.name, ...(ghost ? [" (ghost)"] : []));
    });
  }

  /** Names of the runs and what there is to say of them, over the picture. */
  #head() {
    const rows = this.#names();
    const said = [...this.notes, ...this.#spans(), ...(this.wrong ? [this.wrong] : [])];
    if (this.solid < 0) said.push("There are no poses in this result: signals can be plotted, and nothing is drawn.");
    const more = said.length > SHOWN_NOTES ? [`${said.length - SHOWN_NOTES} more notes stand in the settings.`] : [];
    for (const note of [...said.slice(0, SHOWN_NOTES), ...more]) rows.push(el("div.ali3-note", {}, note));
    this.viewBox.append(el("div.ali3-head", {}, ...rows));
  }

  /** Which runs do not last the whole time. */
  #spans() {
    const { begin, end } = this.clock;
    return this.runs
      .filter(({ t }) => t[0] > begin || t[t.length - 1] < end)
      .map(({ name, t }) => `${name} lasts from ${t[0]} s to ${t[t.length - 1]} s and stands still outside.`);
  }

  /** Beside or below each other, by the form of the window. */
  #shape() {
    const { clientWidth, clientHeight } = this.root;
    this.root.dataset.shape = clientWidth > WIDE * clientHeight ? "wide" : "tall";
    this.dirty = true;
  }

  /** Everything to the time of the clock. */
  #show() {
    for (const sampler of this.samplers) sampler.at(this.clock.time);
    if (this.solid >= 0) {
      this.view.update(this.samplers[this.solid].lookup);
      for (const { drawn, sampler } of this.ghosts) drawn?.update(sampler.lookup);
      for (const { traces, sampler } of this.drawnRuns) traces.update(this.clock.time, sampler.place[0]);
      this.instruments?.show(this.samplers[this.solid].lookup);
      this.view.render();
    }
    this.bar?.now();
    if (this.sideOpen) this.plots?.now();
    this.dirty = false;
  }

  #frame(now) {
    const passed = this.last === undefined ? 0 : (now - this.last) / 1000;
    this.last = now;
    if (this.clock.playing) {
      this.clock.tick(passed);
      this.#show();
      if (!this.clock.playing) this.remember();
    } else if (this.dirty) {
      this.view?.render();
      this.dirty = false;
    }
    this.loopId = requestAnimationFrame((next) => this.#frame(next));
  }

  /** Two pictures later the browser has shown what was drawn. */
  #painted() {
    /** @type {Promise<void>} */
    const shown = new Promise((resolve) => {
      requestAnimationFrame(() => requestAnimationFrame(() => resolve()));
    });
    return shown;
  }
}
