// Bars of the instruments: pedals, steering, engine speed, computing time of a step.
import { el, write } from "../common/dom.js";

/** Colours of bars, in which white words can be read: contrasts of at least 4.5. */
export const FILLS = { blue: "#2f76b8", red: "#d0392f", green: "#23803f", amber: "#9a6400" };

/** A horizontal or vertical bar from 0 to 1, or a bar from -1 to 1 about its middle. */
export class Gauge {
  /**
   * @param {object} options
   * @param {string} options.data name for programs
   * @param {string} [options.label]
   * @param {"across" | "up" | "middle"} [options.way] middle: -1 at the right, +1 at the left, as for steering
   * @param {string} [options.colour]
   */
  constructor({ data, label = "", way = "across", colour = FILLS.blue }) {
    this._way = way;
    this._fill = el("i");
    this._fill.style.background = colour;
    this._colour = colour;
    this._label = el("span", {}, label);
    this.element = el(`div.a3-gauge.a3-gauge-${way}`, { data, title: label }, this._fill, this._label);
    this.show(0);
  }

  /** Shows a value, limited to the range of the bar. @param {number} value @param {string} [colour] */
  show(value, colour = this._colour) {
    const low = this._way === "middle" ? -1 : 0;
    const x = Math.max(low, Math.min(1, Number.isFinite(value) ? value : 0));
    this.value = x;
    const { style } = this._fill;
    if (this._way === "middle") style.transform = `scaleX(${(-x).toFixed(3)})`;
    else style.transform = `${this._way === "up" ? "scaleY" : "scaleX"}(${x.toFixed(3)})`;
    if (style.background !== colour) style.background = colour;
  }

  /** Sets the text in the bar. @param {string} text */
  words(text) {
    write(this._label, text);
  }
}
