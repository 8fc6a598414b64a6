// The bar below the picture: start, stop, single steps, slow motion, going back.
import { button, el, select } from "../common/dom.js";
import { hint } from "../common/key_table.js";

const SLOW = [0.5, 0.25, 0.1, 0.02].map((rate) => [rate, `× 1/${1 / rate}`]);
const SPEEDS = [[1, "× 1"], ...SLOW, [2, "× 2"], [5, "× 5"]];

/** The bar; it calls `act` of the page and shows what it is told. */
export class Bar {
  /** @param {Data} act - Functions: reset, toggle, step, back, speed, scrub, camera, csv, mute, place. */
  constructor(act, { cameras, steps, step, views, places = [], sound = false }) {
    this._play = button("play", "Run", act.toggle, hint("toggle"));
    this._rate = select("rate", `how fast time runs: ${hint("slow")}`, SPEEDS, (v) => act.speed(Number(v)), 1);
    this._line = el("input", { type: "range", min: 0, max: 1, step: "any", title: "go back, then drive on from there", data: "timeline" });
    this._line.addEventListener("input", () => act.scrub(Number(this._line.value)));
    this._time = el("span.a3-clock", { data: "clock" });
    this.element = el(
      "div.a3-bar",
      {},
      button("reset", "Reset", act.reset, hint("reset")),
      button("back", "−2 s", () => act.back(), hint("rewind")),
      this._play,
      button("step", "Step", act.step, hint("step")),
      this._rate,
      this._line,
      this._time,
      select("step size", "communication step", steps, (v) => act.stepSize(Number(v)), step),
    );
    this._camera = select("camera", `camera: ${hint("next camera")}`, cameras.map((c) => [c, c]), act.camera);
    if (cameras.length) this.element.append(this._camera);
    this._sound = button("mute", "Sound on", act.mute, hint("mute"));
    if (sound) this.element.append(this._sound);
    if (places.length) {
      const spots = places.map((name) => [name, name.replaceAll("_", " ")]);
      const place = select("place", "begin at a place of the world", [["", "places …"], ...spots], (name) => {
        if (name) act.place(name);
        place.value = ""; // so that the same one can be chosen again
      });
      this.element.append(place);
    }
    for (const { data, text, title, work } of views) this.element.append(button(data, text, work, title));
    this.element.append(button("csv", "Save CSV", act.csv, "inputs and outputs of the run as a table"), button("help", "?", act.help, hint("help")));
  }

  /** Slow motion, or real time where it is slow. */
  slow() {
    this._rate.value = String(Number(this._rate.value) < 1 ? 1 : SLOW[1][0]);
    this._rate.dispatchEvent(new Event("change"));
  }

  /** A camera was chosen. */
  camera(name) {
    this._camera.value = name;
  }

  /** What the button of the sound says. @param {string} text */
  sound(text) {
    this._sound.textContent = text;
  }

  /**
   * @param {object} now
   * @param {boolean} now.running
   * @param {number} now.oldest - Time one can go back to, s.
   * @param {number} now.time - Of the picture, s.
   * @param {number} now.end - Of the run, s.
   * @param {boolean} now.scrubbed - Whether the picture is that of an earlier instant.
   */
  show({ running, oldest, time, end, scrubbed }) {
    this._play.textContent = running ? "Pause" : scrubbed ? "Run from here" : "Run";
    this._line.min = String(oldest);
    this._line.max = String(Math.max(end, oldest + 1e-6));
    if (document.activeElement !== this._line || running) this._line.value = String(time);
    this._time.textContent = `${time.toFixed(2)} s`;
  }
}
