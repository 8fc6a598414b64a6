// The figures over the picture: speed, gear, engine, time, and how the computer keeps up.
import { el, short, whole } from "../common/dom.js";

const SPEEDS = ["speed"];
export const TURNS = ["engine_speed", "motor_speed"];
export const RPM = 30 / Math.PI;
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

/**
 * The gear in a word: R, N, or its number.
 * @param {(name: string) => number} lookup
 * @param {{selector?: string, gear?: string}} columns - Those that the FMU has.
 */
export function gearWords(lookup, { selector, gear }) {
  if (selector && lookup(selector) < 1) return lookup(selector) < 0 ? "R" : "N";
  return gear ? `gear ${lookup(gear)}` : "";
}

/** Head-up figures of one FMU. */
export class Hud {
  /**
   * @param {Map<string, Data>} variables - Of the FMU by name.
   * @param {string} title
   */
  constructor(variables, title) {
    const has = (names) => names.find((name) => variables.get(name)?.causality === "output");
    this._speed = has(SPEEDS);
    this._turns = has(TURNS);
    this._gear = has(["gear"]);
    this._selector = has(["used.selector"]);
    this._big = el("div.a3-speed", { data: "speed" });
    this._small = el("div.a3-small", { data: "gear" });
    this._time = el("div.a3-small", { data: "time" });
    this._pace = el("div.a3-small", { data: "pace" });
    this._warn = el("div.a3-warn", { data: "behind" });
    this.element = el("div.a3-hud", {}, el("div.a3-title", {}, title), this._big, this._small, this._time, this._pace, this._warn);
  }

  /**
   * @param {(name: string) => number} lookup
   * @param {number} time - s.
   * @param {Parameters<typeof paceWords>[0] | null} pace - See `paceWords`; null for a recording.
   */
  show(lookup, time, pace) {
    if (this._speed) this._big.textContent = `${whole(3.6 * lookup(this._speed))} km/h`;
    const parts = [];
    parts.push(gearWords(lookup, { selector: this._selector, gear: this._gear }));
    if (this._turns) parts.push(`${whole(RPM * lookup(this._turns))} rpm`);
    this._small.textContent = parts.filter(Boolean).join(" · ");
    this._time.textContent = `${time.toFixed(2)} s`;
    const { text, warn } = pace ? paceWords(pace) : { text: "", warn: "" };
    this._pace.textContent = text;
    this._warn.textContent = warn;
  }
}
