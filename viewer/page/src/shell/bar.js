// The bar below the picture, with buttons for the actions of a page.
import { button, el, fixed, icon, select, write } from "../common/dom.js";
import { hint } from "../common/key_table.js";

/** Buttons before and after the slider: an action of the table of keys, and its label if it has no icon. */
const LEFT_BUTTONS = [["reset"], ["rewind"], ["before"], ["toggle"], ["step"], ["upright", "upright"]];
const RIGHT_BUTTONS = [["mute"], ["levers", "levers"], ["panels", "signals"], ["settings", "settings"], ["csv", "CSV"], ["help", "?"], ["full screen"]]; // prettier-ignore
/** @type {Object<string, Parameters<typeof icon>[0]>} */
const ICONS = { reset: "reset", rewind: "rewind", before: "back", toggle: "play", step: "forward", mute: "sound", "full screen": "full" };
const WORDS = { csv: "save inputs and outputs of the run as a table" };

/** The bar. */
export class Bar {
  /**
   * @param {Object<string, (value?: any, done?: boolean) => unknown>} acts of the table of keys; `speed`, `seek`, `camera`, `place`,
   *   `stepSize` are called with a value, `seek` also with true when the slider is released
   * @param {{cameras?: string[], places?: string[], steps?: (string | number)[][], step?: number, speeds?: number[], digits?: number}} has
   */
  constructor(acts, { cameras = [], places = [], steps = [], step, speeds = [], digits = 2 }) {
    this.digits = digits;
    this.list = speeds;
    /** @type {Object<string, HTMLButtonElement>} */
    this.buttons = {};
    this.slide = el("input.a3-slide", { type: "range", min: 0, max: 1, step: "any", title: "time", data: "timeline" });
    for (const end of ["pointerup", "pointercancel", "change"]) this.slide.addEventListener(end, () => (this.held = false));
    this.slide.addEventListener("pointerdown", () => (this.held = true));
    this.slide.addEventListener("input", () => {
      this._showTime(this._seconds(Number(this.slide.value)));
      acts.seek(Number(this.slide.value));
    });
    this.slide.addEventListener("change", () => acts.seek(Number(this.slide.value), true));
    this.clock = el("span.a3-time", { data: "clock" });
    this.rate = select("speed", `speed: ${hint("slow")}`, [], (value) => acts.speed(Number(value)));
    this.cameras = select("camera", `camera: ${hint("next camera")}`, cameras.map((name) => [name, name]), (name) => acts.camera(name)); // prettier-ignore
    const placeOptions = places.map((name) => [name, name.replaceAll("_", " ")]);
    const place = select("place", "begin at a place of the world", [["", "places \u2026"], ...placeOptions], (name) => {
      if (name) acts.place(name);
      place.value = ""; // allows choosing the same place again
    });
    const size = select("step size", "communication step", steps, (value) => acts.stepSize(Number(value)), step);
    const some = (list) => list.filter(([act]) => act in acts && (act !== "full screen" || document.fullscreenEnabled)).map(([act, words]) => this._button(act, words, acts[act])); // prettier-ignore
    const group = (...parts) => el("div.a3-group", {}, ...parts);
    const choices = [[size, steps], [place, places], [this.cameras, cameras]].filter(([, list]) => list.length > 1).map(([choice]) => choice); // prettier-ignore
    this.element = el("div.a3-bar", { data: "bar" }, group(...some(LEFT_BUTTONS)), this.slide, this.clock, group(this.rate), group(...choices, ...some(RIGHT_BUTTONS)));
    this.speed(1);
    this._showTime(this._seconds(0));
    if (this.buttons.mute) this.sound(true);
  }

  _button(act, words, action) {
    const title = WORDS[act] ?? hint(act);
    const element = button(act, words ?? "", () => action({}), title);
    element.setAttribute("aria-label", words ? `${words}: ${title}` : title);
    if (!words) element.append(icon(ICONS[act]));
    this.buttons[act] = element;
    return element;
  }

  _seconds(time) {
    return `${fixed(time, this.digits)} s`;
  }

  /** Shows a time in words, which a screen reader reads at the slider too. @param {string} words */
  _showTime(words) {
    write(this.clock, words);
    this.slide.setAttribute("aria-valuetext", words);
  }

  /** Shows a speed, which need not be in the list. @param {number} chosen */
  speed(chosen) {
    if (this.chosen === chosen) return;
    this.chosen = chosen;
    const all = [...new Set([...this.list, chosen])].sort((a, b) => a - b);
    this.rate.replaceChildren(...all.map((speed) => el("option", { value: speed }, `${speed}\u00d7`)));
    this.rate.value = String(chosen);
  }

  /** Shows the chosen camera. @param {string} name */
  camera(name) {
    this.cameras.value = name;
  }

  /** Shows whether sound is on. @param {boolean} on */
  sound(on) {
    this._state("mute", on, on ? "sound" : "silent");
  }

  /** Shows whether what a button switches is on. @param {string} act @param {boolean} on @param {Parameters<typeof icon>[0]} shown */
  _state(act, on, shown) {
    this.buttons[act].replaceChildren(icon(shown));
    this.buttons[act].setAttribute("aria-pressed", String(on));
  }

  /**
   * @param {{running: boolean, speed: number, time: number, range: [number, number], grows?: boolean}} source current state;
   *   `grows`: the run has no end yet
   */
  show({ running, speed, time, range: [begin, end], grows = false }) {
    const moves = end > begin;
    const { rewind, before, toggle, step } = this.buttons;
    const { activeElement } = document;
    // A control that is disabled loses the focus.
    for (const control of [this.slide, rewind, ...(grows ? [] : [this.rate, before, toggle, step])]) control.disabled = !moves && control !== activeElement;
    if (activeElement !== this.rate) this.speed(speed);
    if (this.held) return;
    Object.assign(this.slide, { min: String(begin), max: String(Math.max(end, begin + 1e-6)), value: String(time) });
    this._showTime(grows ? this._seconds(time) : `${fixed(time, this.digits)} / ${this._seconds(end)}`);
    if (this.shown === running) return;
    this.shown = running;
    this._state("toggle", running, running ? "pause" : "play");
  }
}

/** Number of digits that distinguish consecutive recorded times. @param {number} step s */
export function digitsOf(step) {
  return step > 0 ? Math.min(9, Math.max(2, Math.ceil(-Math.log10(step) - 1e-3))) : 3;
}
