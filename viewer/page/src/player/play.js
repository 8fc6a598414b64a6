// The page of recordings: one is drawn solid, others as ghosts, with their traces on the ground.
import looks from "../../../looks.json" with { type: "json" };
import { el } from "../common/dom.js";
import { instead } from "../common/notices.js";
import { Instruments } from "../instruments/index.js";
import { SceneView } from "../scene/scene_view.js";
import { digitsOf } from "../shell/bar.js";
import { Shell } from "../shell/shell.js";
import { decodePage } from "../sources/decode.js";
import { extremesOf } from "../sources/extremes.js";
import { Recordings } from "../sources/recordings.js";
import { spread } from "../sources/sampler.js";
import { fromHash, toHash } from "./link.js";
import { Traces } from "./traces.js";

const MAX_INTERVAL = 0.5; // s of the run at real time: longest interval within a trail
const SCANNED_TIMES = 200; // number of times at which ranges are determined

/** A page of recordings, the first drawn solid, others as ghosts; what programs use is in docs/animation.md. */
export class Player extends Shell {
  /** @type {SceneView[]} */
  _drawn = [];
  _wrong = "";
  /** @type {{traces: Traces, sampler: import("../sources/sampler.js").Sampler}[]} */
  drawnRuns = [];

  /** @param {HTMLElement} container an element with a size @param {Data} page JSON as viewer/page_data.py writes it */
  constructor(container, page) {
    super(container, page.options);
    /** Resolved when the first picture or an error is shown. */
    this.ready = decodePage(page)
      .then((given) => this._open(given))
      .catch((error) => {
        this._wrong = error.message;
        instead(container, "problem", `This page cannot be shown: ${error.message}`);
      });
  }

  /** @param {{runs: import("../sources/decode.js").Run[], options?: Data}} given */
  _open({ runs, options = {} }) {
    this.runs = runs;
    /** @type {Data} */
    this.options = { ...options, ...(options.controls === false ? {} : fromHash(location.hash)) };
    this.quality = this.options.quality ?? "auto";
    this.source = new Recordings(runs, this.options);
    this.plotted = this.options.plots ?? [];
    this.source.changed = (moved) => this._moved(moved);
    const { arrows, arrow_scale: arrowScale, stress, deformation, path, closed } = this.options;
    const requested = { arrows, arrowScale, stress, deformation, path, closed };
    for (const [name, value] of Object.entries(requested)) if (value !== undefined) this.look[name] = value;
    this._draw();
    if (this.options.controls !== false) this._controls();
    else if (this.ghosts.length > 0) this._addNames(); // for pictures and films
    document.addEventListener("visibilitychange", () => (this.last = undefined), { signal: this.listeners.signal }); // time in a hidden page does not count
    this._show();
    if (this.options.play) this.play();
    this.loopId = requestAnimationFrame((now) => this._frame(now));
    return this._painted();
  }

  get views() {
    return this._drawn;
  }

  /** Reason why nothing is drawn; empty if something is. */
  get problem() {
    return this._wrong || (this.view?.problem ?? "");
  }

  get time() {
    return this.source.time;
  }

  /** Notes of the runs: thinning, gaps. */
  get notes() {
    const several = this.runs.length > 1;
    return this.runs.flatMap(({ name, notes = [] }) => notes.map((note) => (several ? `${name}: ${note}` : note)));
  }

  play() {
    if (!this.source.running) this.toggle();
  }

  pause() {
    if (this.source.running) this.toggle();
  }

  toggle() {
    this.source.acts.toggle();
  }

  /** Shows a time. @param {number} t s @returns {Promise<void>} resolved when the picture is on the screen */
  seek(t) {
    return this.source.acts.seek(t);
  }

  /** Sets the speed of playing. @param {number} speed from 0.05 to 10 */
  speed(speed) {
    this.source.acts.speed(speed);
  }

  /** Updates the page. @param {boolean} moved whether the time has changed */
  _moved(moved) {
    if (moved) this._show();
    this.bar?.show(this.source);
    this.settings?.refresh({ loop: this.source.loop });
    this.changed();
    return this._painted();
  }

  /** The same as `setLook`, for programs. @param {Data} look */
  set(look) {
    this.setLook(look);
  }

  /** Changes the look. @param {Data} look as that of the shell */
  setLook(look) {
    super.setLook(look);
    if (look.deformation !== undefined && this.solid >= 0) {
      this._scan(); // the floor is below the deformed parts
      this._show();
    }
    if (look.path !== undefined) for (const { traces } of this.drawnRuns) traces.show(look.path);
  }

  /** Shows or hides a ghost. @param {Data} ghost @param {boolean} on */
  showGhost(ghost, on) {
    if (on) ghost.drawn ??= this.view.addGhost(ghost.run.scene, ghost.options);
    else {
      ghost.drawn?.remove();
      ghost.drawn = undefined;
    }
    this.drawnRuns.find(({ sampler }) => sampler === ghost.sampler)?.traces.show(on && this.look.path);
    this._show();
  }

  /** Updates the address after a change of a setting in it. */
  changed() {
    if (!this.source.running) this.remember();
  }

  /** Writes the settings to the address, so that it can be shared. */
  remember() {
    if (this.options.controls === false || !/^(https?|file):$/.test(location.protocol)) return;
    clearTimeout(this.later);
    const state = { time: this.time, camera: this.cameraName === this.cameras[0] ? "" : this.cameraName, plots: this.plots?.chosen ?? [], speed: this.source.speed };
    this.later = setTimeout(() => history.replaceState(null, "", toHash(state)), 150); // browsers limit the rate
  }

  dispose() {
    cancelAnimationFrame(this.loopId);
    clearTimeout(this.later);
    for (const { traces } of this.drawnRuns) traces.dispose();
    this.view?.dispose();
    super.dispose();
  }

  /** Makes the picture of the first run with a scene; the other runs are ghosts. */
  _draw() {
    this.solid = this.runs.findIndex(({ scene }) => scene !== null && scene !== undefined);
    if (this.solid < 0) return;
    const { scene } = this.runs[this.solid];
    const picture = el("div.a3-view");
    const hasControls = this.options.controls !== false;
    this.viewBox.append(picture);
    this._drawn.push(new SceneView(picture, scene, { words: hasControls, keep: !hasControls, driven: hasControls, quality: this.options.quality, onMessage: (sentence) => hasControls && this.notices.note(sentence) }));
    this.view.set(this.look);
    this._scan();
    this._addTraces(this.solid);
    for (const [k, run] of this.runs.entries()) {
      if (k === this.solid || !run.scene || this.problem) continue;
      const options = { name: run.name, tint: looks.ghosts[this.ghosts.length % looks.ghosts.length] };
      this.ghosts.push({ name: run.name, run, options, sampler: this.source.samplers[k], drawn: this.view.addGhost(run.scene, options) });
      this._lower(run, this.ghosts.at(-1).drawn);
      this._addTraces(k, { tint: options.tint, under: this.ghosts.length });
    }
    const { way } = this.drawnRuns[0].traces;
    if (way.length > 0) this.view.stand(way);
    this.has = { ...this.view.has, path: this.drawnRuns.some(({ traces }) => traces.paths.length > 0) };
    this.cameras = this.view.cameraNames;
    this.cameraName = this.cameras[0];
    if (this.options.camera !== undefined) this.wrong = this.camera(this.options.camera);
    this.watch(picture);
  }

  /** Adds the traces of a run. @param {number} k of the run @param {{tint: string, under: number}} [ghost] */
  _addTraces(k, ghost) {
    const traces = new Traces(this.view, this.runs[k], ghost);
    traces.show(this.look.path);
    this.drawnRuns.push({ traces, sampler: this.source.samplers[k] });
  }

  /** Samples the run for constant floor height and scales of arrows and colours. */
  _scan() {
    const { t, columns } = this.runs[this.solid];
    const samples = spread(t.length, SCANNED_TIMES);
    this.view.scan((i) => (name) => columns[name]?.data[samples[i]], samples.length);
    this._lower(this.runs[this.solid], this.view);
    for (const { run, drawn } of this.ghosts) this._lower(run, drawn);
  }

  /** Lowers the floor below the extreme poses of a run. @param {import("../sources/decode.js").Run} run @param {Data} drawn */
  _lower(run, drawn) {
    if (this.problem || (this.runs[this.solid].scene.roads ?? []).length > 0) return; // a road replaces the floor
    const instants = extremesOf(run);
    drawn?.lower((i) => (name) => run.columns[name]?.data[instants[i]], instants.length);
  }

  _controls() {
    this._addNames();
    for (const note of [...this.notes, ...this._spans(), ...(this.wrong ? [this.wrong] : [])]) this.notices.note(note);
    const { scene, columns = {}, constants = {} } = this.runs[this.solid] ?? {};
    const names = new Set(Object.keys(columns));
    if (!this.problem && Instruments.of(names)) {
      this.instruments = new Instruments(names, { scene, fixed: (name) => constants[name] });
      this.viewBox.append(this.instruments.layer());
    }
    const plotsOnly = this.solid < 0;
    if (plotsOnly) {
      this.root.dataset.plotsOnly = "yes";
      this.notices.note("There are no poses in this result: signals can be plotted, and nothing is drawn.");
    }
    const { t } = this.runs[0];
    const instruments = this.instruments ? { instruments: () => this.instruments.toggle() } : {};
    this.controls(this.source, instruments, { digits: digitsOf((t[t.length - 1] - t[0]) / Math.max(1, t.length - 1)) });
    if (plotsOnly || this.plotted.length) this.side(true);
  }

  /** Adds the names of the runs with the colours of their paths above the notices. */
  _addNames() {
    const names = this.runs.map((run, k) => {
      const ghost = this.ghosts.find((other) => other.run === run);
      const colour = ghost?.options.tint ?? (k === this.solid && this.ghosts.length > 0 ? looks.paths.body : undefined);
      const swatch = colour ? [el("span.a3-swatch", { style: `background:${colour}` })] : [];
      return el("div", {}, ...swatch, run.name, ...(ghost ? [" (ghost)"] : []));
    });
    this.notices.element.prepend(el("div.a3-head", {}, ...names));
  }

  /** Sentences on runs that do not cover the whole time. */
  _spans() {
    const [begin, end] = this.source.range;
    return this.runs
      .filter(({ t }) => t[0] > begin || t[t.length - 1] < end)
      .map(({ name, t }) => `${name} lasts from ${t[0]} s to ${t[t.length - 1]} s and stands still outside.`);
  }

  /** Updates everything to the current time. */
  _show() {
    const numbers = this.source.sample();
    if (this.solid >= 0) {
      this.view.update(numbers[this.solid]);
      for (const { drawn, sampler } of this.ghosts) drawn?.update(sampler.lookup);
      for (const { traces, sampler } of this.drawnRuns) traces.update(this.time, sampler.place[0]);
      const { samplers, speed } = this.source;
      this.instruments?.plan.trail.at(this.time, this.runs[this.solid].epoch[samplers[this.solid].place[0]], MAX_INTERVAL * Math.max(1, speed));
      this.instruments?.show(numbers[this.solid]);
      this.view.render();
    }
    this.bar?.show(this.source);
    if (this.sideOpen) this.plots?.now();
    this.dirty = false;
  }

  _frame(now) {
    const passed = this.last === undefined ? 0 : (now - this.last) / 1000;
    this.last = now;
    if (this.source.running) {
      this.source.tick(passed);
      this._show();
      if (!this.source.running) this.remember();
    } else if (this.dirty) {
      this.view?.render();
      this.dirty = false;
    }
    this.loopId = requestAnimationFrame((next) => this._frame(next));
  }

  /** Resolved when the browser has shown the drawn picture, which takes two frames. */
  _painted() {
    /** @type {Promise<void>} */
    const shown = new Promise((resolve) => {
      requestAnimationFrame(() => requestAnimationFrame(() => resolve()));
    });
    return shown;
  }
}
