// The figures over the picture of a run: its name, time, and how the computer keeps up.
import { el, short } from "../common/dom.js";

/** Beyond this the machine does not keep up. */
const SLOW = 0.97;

/** What the machine does, in words; a warning where it is slower than asked for. */
export function paceWords({ running, speed, factor, cost, step }) {
  const wanted = speed === 1 ? "real time" : speed < 1 ? `slow motion × ${short(speed)}` : `fast × ${short(speed)}`;
  const work = cost > 0 ? `${short(1e6 * cost)} µs a step of ${short(1e3 * step)} ms` : "";
  if (!running) return { text: ["paused", work].filter(Boolean).join(" · "), warn: "" };
  const got = factor === null ? "" : ` (× ${factor.toFixed(2)})`;
  const late = factor !== null && factor < SLOW * speed;
  const warn = late ? `This machine does not keep up: ${factor.toFixed(2)} s of the run a second, ${short(speed)} asked for.` : "";
  return { text: [`${wanted}${got}`, work].filter(Boolean).join(" · "), warn };
}

/** Head-up figures of one FMU. */
export class Hud {
  /** @param {string} title */
  constructor(title) {
    this._time = el("div.a3-small", { data: "time" });
    this._pace = el("div.a3-small", { data: "pace" });
    this._warn = el("div.a3-warn", { data: "behind" });
    this.element = el("div.a3-hud", {}, el("div.a3-title", {}, title), this._time, this._pace, this._warn);
  }

  /**
   * @param {number} time - s.
   * @param {Parameters<typeof paceWords>[0] | null} pace - See `paceWords`; null for a recording.
   */
  show(time, pace) {
    this._time.textContent = `${time.toFixed(2)} s`;
    const { text, warn } = pace ? paceWords(pace) : { text: "", warn: "" };
    this._pace.textContent = text;
    this._warn.textContent = warn;
  }
}
