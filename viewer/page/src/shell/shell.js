// The shell of every page: pictures of a source of numbers, what stands beside them, the bar below, settings, keys.
import { el } from "../common/dom.js";
import { Help } from "../common/help.js";
import { keys } from "../common/keys.js";
import { Notices } from "../common/notices.js";
import { cameraActs } from "../common/views.js";
import { ARBITER_MS } from "../live/input_arbiter.js";
import { gamepadPanel } from "../live/panel.js";
import { styled } from "../styles.js";
import { Bar } from "./bar.js";
import { Plots } from "./plots.js";
import { Settings } from "./settings.js";
import style from "./style.css";

const WIDE = 1.15; // width over height from which signals stand beside the picture

/** A lookup of the numbers of one instant. @typedef {(name: string) => number | undefined} Lookup */

/**
 * What a page shows: a recording, an FMU that runs in the tab, a car at the other end of a socket.
 * @typedef {object} Source
 * @property {[number, number]} range - Times that can be shown, s; `grows`: the run has no end yet.
 * @property {boolean} [grows]
 * @property {number} time - That is shown, s.
 * @property {boolean} running
 * @property {number} speed - Simulated seconds per second of the clock.
 * @property {number[]} speeds - To choose from.
 * @property {Map<string, string>} columns - Names and units of all numbers.
 * @property {(t?: number) => Lookup[]} sample - Numbers of each run at a time; without one at the time that is shown.
 * @property {(names: string[], span: number) => Data[]} plotted - Runs with times and columns of these names; of a run
 *   that grows the last so many seconds.
 * @property {(source: string, wants: [string, number, number?][]) => void} [want] - Inputs, values, largest changes per second.
 * @property {Object<string, (value?: any) => unknown>} acts - What it can do, by the names of the table of keys; what
 *   it cannot, no page offers.
 */

/** A page; what draws is made by those who extend it. */
export class Shell {
  listeners = new AbortController();
  look = { arrows: false, arrowScale: 1, stress: false, deformation: 1, path: true, closed: true };
  /** What `set` can change, by name. @type {Data} */
  has = {};
  /** Names of cameras. @type {string[]} */
  cameras = [];
  /** @type {Data[]} see-through runs */
  ghosts = [];
  dirty = true;
  /** What the page shows; see `Source`. @type {any} */
  source;
  /** Signals over time, made when they are first shown. @type {Plots | undefined} */
  plots;
  /** Names of the signals that are plotted at first. @type {string[]} */
  plotted = [];
  dark = matchMedia("(prefers-color-scheme: dark)");

  /** @param {HTMLElement} container an element with a size @param {{theme?: string, kind?: string}} [options] `kind`: a class of the page */
  constructor(container, { theme = "auto", kind = "" } = {}) {
    styled(style);
    this.container = container;
    /** What there is to say. */
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
   * Bar, settings and keys over a source.
   * @param {Source} source
   * @param {Object<string, (value?: any) => unknown>} more acts of this page
   * @param {Data} [bar] what the bar has, as `Bar` takes it
   * @param {(event: KeyboardEvent) => boolean} [drive] takes the keys that drive a car
   */
  controls(source, more, bar = {}, drive) {
    this.source = source;
    const switches = ["arrows", "stress", "closed", "path"].filter((what) => this.has[what]);
    const camera = (name) => this.tell(this.camera(name));
    this.acts = {
      ...source.acts,
      camera,
      ...cameraActs({ names: () => this.cameras, all: this.cameras, now: () => this.cameraName, choose: camera }),
      ...Object.fromEntries(switches.map((what) => [what, () => this.setLook({ [what]: !this.look[what] })])),
      panels: () => this.side(!this.sideOpen),
      settings: () => this.settings.toggle(),
      help: () => this.help.toggle(),
      close: () => (this.settings.toggle(false), this.help.toggle(false)),
      "full screen": () => this._fullScreen(),
      ...(drive ? { levers: () => this.root.classList.toggle("a3-touching"), mute: () => this.mute(!this.muted) } : {}),
      ...more,
    };
    if (source.grows) this.root.dataset.grows = "yes";
    this.bar = new Bar(this.acts, { speeds: source.speeds, cameras: this.cameras, ...bar });
    if (this.cameraName) this.bar.camera(this.cameraName);
    this.foot.append(this.bar.element);
    this.settings = new Settings(this.foot, this, source);
    this.help = new Help(Object.keys(this.acts), drive !== undefined);
    this.root.append(this.help.element);
    keys({ acts: this.acts, first: drive, signal: this.listeners.signal });
  }

  /**
   * Keys and a gamepad drive from now on. Those who extend this have `driverSpeed`, `sound` and `unseen`.
   * @param {import("../live/input_arbiter.js").InputArbiter} hands @param {string[]} inputs @returns {HTMLElement} the panel of the gamepad
   */
  driven(hands, inputs) {
    this.hands = hands;
    this._gamepad = gamepadPanel(hands.gamepad, inputs);
    const { signal } = this.listeners;
    for (const event of ["keydown", "pointerdown"]) window.addEventListener(event, () => this._touch(), { signal });
    window.addEventListener("blur", () => hands.letKeysGo(), { signal });
    document.addEventListener("visibilitychange", () => document.hidden && this.unseen(), { signal });
    this._asking = setInterval(() => this.poll(), ARBITER_MS);
    return this._gamepad.element;
  }

  /** Sound begins with the first touch of the page, as browsers want it. */
  _touch() {
    if (this._touched) return;
    this._touched = true;
    this.sound();
  }

  /** Look at the hands, by a clock of their own. */
  poll() {
    const { changed, lost } = this.hands.poll(this.driverSpeed);
    if (lost) this.tell("The gamepad is gone: its pedals and steering are let go.");
    if (changed) this._gamepad.fill();
    this._gamepad.show();
  }

  /** Speed of the car that is driven, m/s. */
  get driverSpeed() {
    return 0;
  }

  /** Sound may begin. */
  sound() {}

  /** Nobody sees the page any more. */
  unseen() {}

  _fullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.root.requestFullscreen?.().catch(() => {}); // a browser may refuse it, as in a frame
  }

  /** A hand on a picture changes it. @param {HTMLElement} box */
  watch(box) {
    for (const event of ["pointerdown", "pointermove", "wheel", "touchmove", "pointerup"]) {
      box.addEventListener(event, () => (this.dirty = true), { passive: true, signal: this.listeners.signal });
    }
  }

  /** @param {string} name @returns {string} a sentence if there is no such camera, else empty */
  camera(name) {
    if (!this.cameras.includes(name)) return `There is no camera '${name}'; there are ${this.cameras.join(", ") || "none"}.`;
    for (const view of this.views) if (view.cameraNames.includes(name)) view.camera(name);
    this.cameraName = name;
    this.bar?.camera(name);
    this.dirty = true;
    this.changed();
    return "";
  }

  /** Change what pictures show. @param {Data} look as `SceneView.set` has it, with `path` */
  setLook(look) {
    if (look.stress && this.look.closed && look.closed === undefined && this.has.closed) look.closed = false; // what has the colours is within
    Object.assign(this.look, look);
    for (const view of this.views) view.set(look);
    this.settings?.refresh(look);
    this.dirty = true;
  }

  /** Show or hide what stands beside the picture. @param {boolean} open */
  side(open) {
    if (open) this.plots ??= new Plots(this.sideBox, this, this.source, this.plotted);
    this.sideBox.hidden = !open;
    this.bar?.buttons.panels.setAttribute("aria-pressed", String(open));
    this.shape();
    this.plots?.resize();
  }

  /** Colours of the page. @param {string} name auto, light or dark */
  theme(name) {
    this.themeName = name;
    this.dark.onchange = () => this.theme(this.themeName);
    this.root.dataset.theme = name === "auto" ? (this.dark.matches ? "dark" : "light") : name;
    this.plots?.redraw();
  }

  /** Beside or below each other, by the form of the window. */
  shape() {
    const { clientWidth, clientHeight } = this.root;
    this.root.dataset.shape = clientWidth > WIDE * clientHeight ? "wide" : "tall";
    this.dirty = true;
  }

  /** Sound of a car is heard or not; what sounds is of those who extend this. @param {boolean} on */
  mute(on) {
    this.muted = on;
    this.bar.sound(!on);
  }

  /** Say over the picture that something has happened. @param {string} sentence */
  tell(sentence) {
    this.notices.tell(sentence);
  }

  /** What the address of the page may tell has changed. */
  changed() {}

  dispose() {
    this.listeners.abort();
    clearInterval(this._asking);
    this.observer.disconnect();
    this.plots?.dispose();
    this.dark.onchange = null;
    this.root.remove();
  }
}
