// What one can do with the run: pause, step, slow motion, rewind, set upright, begin again, go to a place.
import { button, el, select, write } from "../common/dom.js";
import { hint } from "../common/key_table.js";
import { qualityChoice } from "../live/panel.js";

/** Simulated seconds per second of the clock. */
const SPEEDS = [[1, "× 1"], [0.5, "× 1/2"], [0.25, "× 1/4"], [0.1, "× 1/10"]]; // prettier-ignore
export const REWINDS = [2, 10];

/** The controls over the picture. */
export class Controls {
  /**
   * @param {Data} act - Functions: toggle, step, speed, back, upright, reset, place, camera, quality, mute, panels, help.
   * @param {{cameras: string[], places: {name: string, text?: string}[]}} has
   */
  constructor(act, { cameras, places }) {
    this._run = button("run", "Pause", act.toggle, hint("toggle"));
    this._speed = select("speed choice", hint("slow"), SPEEDS, (value) => act.speed(Number(value)), 1);
    this._back = button("rewind", `${REWINDS[0]} s back`, () => act.back(REWINDS[0]), hint("rewind"));
    this._saved = el("input", { type: "range", min: 0, max: 30, step: 0.1, value: 0, data: "saved", title: "what is saved: choose how far to rewind" });
    this._far = el("output", { data: "rewind by" });
    this._saved.addEventListener("input", () => this._showFar());
    this._saved.addEventListener("change", () => this._rewind(act));
    this._camera = select("camera", `camera: ${hint("next camera")}`, cameras.map((name) => [name, name]), act.camera); // prettier-ignore
    this._quality = qualityChoice(act.quality);
    this._sound = button("mute", "Sound on", act.mute, hint("mute"));
    const spots = places.map(({ name }) => [name, name.replaceAll("_", " ")]);
    this._place = select("place", "begin at a place of the world", [["", "places …"], ...spots], (name) => this._go(act, name));
    this._place.hidden = places.length === 0;
    this.element = el(
      "div.a3-controls",
      { data: "controls" },
      el("div", {}, this._run, button("step", "Step", act.step, hint("step")), this._speed),
      el("div", {}, this._back, this._saved, this._far, button("upright", "Upright", act.upright, hint("upright"))),
      el("div", {}, button("reset", "Reset", act.reset, hint("reset")), this._place),
      el("div", {}, this._camera, this._quality, this._sound, button("panels", "Panels", act.panels, hint("panels"))),
      button("help", "?", act.help, hint("help")),
    );
  }

  /** What is true now. @param {{running: boolean, speed: number, saved: number}} frame */
  show({ running, speed, saved }) {
    write(this._run, running ? "Pause" : "Run");
    const held = document.activeElement === this._saved;
    if (!held) {
      this._saved.max = String(Math.max(0.1, saved));
      this._saved.value = "0";
      this._showFar();
    }
    this._saved.disabled = !held && !(saved > 0);
    this._back.disabled = !(saved > 0);
    if (document.activeElement !== this._speed) this._showSpeed(speed);
  }

  /** A camera was chosen. */
  camera(name) {
    this._camera.value = name;
  }

  /** What the button of the sound says. @param {string} text */
  sound(text) {
    write(this._sound, text);
  }

  _showSpeed(speed) {
    const known = SPEEDS.some(([value]) => value === speed);
    if (!known && ![...this._speed.options].some(({ value }) => Number(value) === speed)) {
      this._speed.append(el("option", { value: speed }, `× ${speed}`));
    }
    if (Number(this._speed.value) !== speed) this._speed.value = speed;
  }

  _showFar() {
    const far = Number(this._saved.value);
    write(this._far, far > 0 ? `−${far.toFixed(1)} s` : "");
  }

  _rewind(act) {
    const far = Number(this._saved.value);
    if (far > 0) act.back(far);
    this._saved.blur();
  }

  _go(act, name) {
    if (name) act.place(name);
    this._place.value = "";
  }
}
