// The base of all pages: pictures of a source, panel beside them, bar below, settings, keys.
import { el } from "../common/dom.js";
import { Help } from "../common/help.js";
import { keys, show } from "../common/keys.js";
import { Notices } from "../common/notices.js";
import { cameraActs } from "../common/views.js";
import { ARBITER_MS } from "../live/input_arbiter.js";
import { gamepadPanel } from "../live/panel.js";
import { styled } from "../styles.js";
import { Bar } from "./bar.js";
import { Plots } from "./plots.js";
import { Settings } from "./settings.js";
import style from "./style.css";

const WIDE_RATIO = 1.15; // least ratio of width to height for signals beside the picture

/** Values of columns at a time. @typedef {(name: string) => number | undefined} Lookup */

/**
 * A source of a page: recordings, FMUs that run in it, or a car that another program simulates.
 * @typedef {object} Source
 * @property {[number, number]} range times that can be shown, s
 * @property {boolean} [grows] whether the run has no end yet
 * @property {number} time current time, s
 * @property {boolean} running
 * @property {number} speed simulated seconds per second of the clock
 * @property {number[]} speeds selectable speeds
 * @property {Map<string, string>} columns units of all columns by name
 * @property {(t?: number) => Lookup[]} sample values of each run at a time, by default at the current time
 * @property {(names: string[], span: number) => Data[]} plotted runs with times and columns of these names; for a run
 *   that grows, over the last `span` seconds.
 * @property {(source: string, wants: [string, number, number?][]) => void} [want] inputs, values, largest changes per second
 * @property {Object<string, (value?: any) => unknown>} acts its actions by the names of the table of keys
 */

/** A page; derived classes add the pictures. */
export class Shell {
  listeners = new AbortController();
  look = { arrows: false, arrowScale: 1, stress: false, deformation: 1, path: true, closed: true };
  /** Whether `set` can change a part of the look, by name. @type {Data} */
  has = {};
  /** Names of cameras. @type {string[]} */
  cameras = [];
  /** Transparent runs. @type {Data[]} */
  ghosts = [];
  dirty = true;
  /** See `Source`. @type {any} */
  source;
  /** Plots, made on first use. @type {Plots | undefined} */
  plots;
  /** Names of the initially plotted signals. @type {string[]} */
  plotted = [];
  dark = matchMedia("(prefers-color-scheme: dark)");

  /** @param {HTMLElement} container an element with a size @param {{theme?: string, kind?: string}} [options] `kind`: a class of the page */
  constructor(container, { theme = "auto", kind = "" } = {}) {
    styled(style);
    this.container = container;
    this.notices = new Notices();
    this.viewBox = el("div.a3-views", {}, this.notices.element);
    this.sideBox = el("aside.a3-side", { hidden: true, data: "panel", "aria-label": "signals" });
    this.stageBox = el("div.a3-stage", {}, this.viewBox, this.sideBox);
    this.foot = el("div.a3-foot");
    this.root = el(`div.a3${kind}`, { tabIndex: -1 }, this.stageBox, this.foot);
    container.replaceChildren(this.root);
    this.observer = new ResizeObserver(() => this.shape());
    this.observer.observe(this.root);
    this.theme(theme);
    this.shape();
  }

  /** Pictures of the page. @returns {import("../scene/scene_view.js").SceneView[]} */
  get views() {
    return [];
  }

  /** The first picture. */
  get view() {
    return this.views[0];
  }

  get sideOpen() {
    return !this.sideBox.hidden;
  }

  /**
   * Adds bar, settings and keys for a source.
   * @param {Source} source
   * @param {Object<string, (value?: any) => unknown>} more actions of this page
   * @param {Data} [bar] options of `Bar`
   * @param {(event: KeyboardEvent) => boolean} [drive] handles the keys that drive a car
   */
  controls(source, more, bar = {}, drive) {
    this.source = source;
    const switches = ["arrows", "stress", "closed", "path"].filter((effect) => this.has[effect]);
    const camera = (name) => this.tell(this.camera(name));
    this.acts = {
      ...source.acts,
      camera,
      ...cameraActs(this.cameras, () => this.cameraName, camera),
      ...Object.fromEntries(switches.map((effect) => [effect, () => this.setLook({ [effect]: !this.look[effect] })])),
      panels: () => this.side(!this.sideOpen),
      settings: () => this.settings.toggle(),
      help: () => this.help.toggle(),
      close: () => (this.settings.toggle(false), this.help.toggle(false)),
      "full screen": () => this._fullScreen(),
      ...(drive ? { levers: () => this.touch(!this.root.classList.contains("a3-touching")), mute: () => this.mute(!this.muted) } : {}),
      ...more,
    };
    if (source.grows) this.root.dataset.grows = "yes";
    this.bar = new Bar(this.acts, { speeds: source.speeds, cameras: this.cameras, ...bar });
    if (this.cameraName) this.bar.camera(this.cameraName);
    this.foot.append(this.bar.element);
    this.notices.fallbackFocus = this.bar.buttons.toggle;
    if (drive) this.touch(matchMedia("(pointer: coarse)").matches);
    this.settings = new Settings(this.foot, this, source);
    const ofParts = ["zoom", ...(this.view ? ["turn", "pick"] : [])]; // keys of pictures, maps and diagrams
    this.help = new Help([...Object.keys(this.acts), ...ofParts], drive !== undefined);
    this.root.append(this.help.element);
    keys({ acts: this.acts, first: drive, dialog: this.help.element, signal: this.listeners.signal });
  }

  /**
   * Starts driving by keys and gamepad; derived classes define `driverSpeed`, `sound` and `unseen`.
   * @param {import("../live/input_arbiter.js").InputArbiter} hands @param {string[]} inputs @returns {HTMLElement} the panel of the gamepad
   */
  driven(hands, inputs) {
    this.hands = hands;
    this._gamepad = gamepadPanel(hands.gamepad, inputs);
    const { signal } = this.listeners;
    for (const event of ["keydown", "pointerdown"]) window.addEventListener(event, () => this._startSound(), { signal });
    window.addEventListener("blur", () => hands.letKeysGo(), { signal });
    document.addEventListener("visibilitychange", () => document.hidden && this.unseen(), { signal });
    this._pollTimer = setInterval(() => this.poll(), ARBITER_MS);
    return this._gamepad.element;
  }

  /** Starts the sound at the first click or key, as browsers require. */
  _startSound() {
    if (this._soundStarted) return;
    this._soundStarted = true;
    this.sound();
  }

  /** Reads keys and gamepad. */
  poll() {
    const { changed, lost } = this.hands.poll(this.driverSpeed);
    if (lost) this.tell("The gamepad is gone: its pedals and steering are let go.");
    if (changed) this._gamepad.fill();
    this._gamepad.show();
  }

  /** Speed of the driven car, m/s. */
  get driverSpeed() {
    return 0;
  }

  /** Starts the sound. */
  sound() {}

  /** Called when the page is hidden. */
  unseen() {}

  _fullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.root.requestFullscreen?.().catch(() => {}); // browsers may refuse it, such as in a frame
  }

  /** Marks pictures as changed at events of mouse, touch and keys. @param {HTMLElement} box */
  watch(box) {
    for (const event of ["pointerdown", "pointermove", "wheel", "touchmove", "pointerup", "keydown"]) {
      box.addEventListener(event, () => (this.dirty = true), { passive: true, signal: this.listeners.signal });
    }
  }

  /** Chooses a camera. @param {string} name @returns {string} a sentence if there is no such camera, else empty */
  camera(name) {
    if (!this.cameras.includes(name)) return `There is no camera '${name}'; there are ${this.cameras.join(", ") || "none"}.`;
    for (const view of this.views) if (view.cameraNames.includes(name)) view.camera(name);
    this.cameraName = name;
    this.bar?.camera(name);
    this.dirty = true;
    this.changed();
    return "";
  }

  /** Changes the look of pictures. @param {Data} look as of `SceneView.set`, with `path` */
  setLook(look) {
    if (look.stress && this.look.closed && look.closed === undefined && this.has.closed) look.closed = false; // the coloured parts are inside
    Object.assign(this.look, look);
    for (const view of this.views) view.set(look);
    this.settings?.refresh(look);
    this.dirty = true;
  }

  /** Shows or hides the panel beside the picture. @param {boolean} open */
  side(open) {
    if (open) this.plots ??= new Plots(this.sideBox, this, this.source, this.plotted);
    show(this.sideBox, open, this.bar?.buttons.panels);
    this.shape();
    this.plots?.resize();
  }

  /** Sets the colours of the page. @param {string} name auto, light or dark */
  theme(name) {
    this.themeName = name;
    this.dark.onchange = () => this.theme(this.themeName);
    this.root.dataset.theme = name === "auto" ? (this.dark.matches ? "dark" : "light") : name;
    this.plots?.redraw();
  }

  /** Puts the panel beside or below the picture, depending on the window. */
  shape() {
    const { clientWidth, clientHeight } = this.root;
    this.root.dataset.shape = clientWidth > WIDE_RATIO * clientHeight ? "wide" : "tall";
    this.dirty = true;
  }

  /** Shows or hides the levers for fingers. @param {boolean} on */
  touch(on) {
    this.root.classList.toggle("a3-touching", on);
    this.bar.buttons.levers.setAttribute("aria-pressed", String(on));
  }

  /** Switches the sound on or off in the bar; derived classes do so for the sound itself. @param {boolean} on */
  mute(on) {
    this.muted = on;
    this.bar.sound(!on);
  }

  /** Shows an event over the picture. @param {string} sentence */
  tell(sentence) {
    this.notices.tell(sentence);
  }

  /** Called after a change of a setting in the address. */
  changed() {}

  dispose() {
    this.listeners.abort();
    clearInterval(this._pollTimer);
    this.observer.disconnect();
    this.plots?.dispose();
    this.dark.onchange = null;
    this.root.remove();
  }
}
