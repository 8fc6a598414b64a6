// Shows time and real-time factor of a run and, on a key, computing time of steps and frame rate.
import { el, fixed, write } from "../common/dom.js";
import { styled } from "../styles.js";
import { realTimeText } from "../sources/factor.js";
import { FILLS, Gauge } from "./gauges.js";
import style from "./style.css";

/** Text of a duration. */
const durationText = (seconds) => (seconds < 9.995e-4 ? `${(1e6 * seconds).toFixed(0)} µs` : `${(1e3 * seconds).toFixed(seconds < 0.01 ? 2 : 0)} ms`);

/** Display of times. */
export class Timing {
  /** @param {string} [title] of the run */
  constructor(title = "") {
    styled(style);
    this._time = el("div", { data: "time" });
    this._pace = el("div", { data: "pace" });
    this._bar = new Gauge({ data: "step time", colour: FILLS.green });
    this._worst = el("u", { title: "the longest step of the last second" });
    this._bar.element.append(this._worst);
    this._missed = el("div", { data: "missed" });
    this._flow = el("div", { data: "flow" });
    this._costs = el("div", { hidden: true }, this._bar.element, this._missed, this._flow);
    this.element = el("div.a3-timing", { data: "timing" }, el("b", {}, title), this._time, this._pace, this._costs);
  }

  /** Shows or hides the computing times. */
  toggle() {
    this._costs.hidden = !this._costs.hidden;
  }

  /**
   * @param {number} time s
   * @param {Data | null} pace as for `realTimeText`, with `cost` and `deadline` of a step, s; of a simulator also `worst`,
   *   `missed`, `lateness` and the `flow` of pictures; null for a recording
   * @returns {string} a warning if the machine is too slow
   */
  show(time, pace) {
    write(this._time, `${fixed(time, 2)} s`);
    if (pace === null) return "";
    const { text, warn } = realTimeText(/** @type {any} */ (pace));
    write(this._pace, text);
    if (!this._costs.hidden) this._show(pace);
    return warn;
  }

  /** @param {Data} pace */
  _show({ cost, deadline, worst = 0, missed, lateness, flow }) {
    const [share, most] = deadline > 0 ? [cost / deadline, worst / deadline] : [0, 0];
    this._bar.show(share, share > 1 ? FILLS.red : share > 0.5 ? FILLS.amber : undefined);
    this._bar.words(`step ${durationText(cost)} of ${durationText(deadline)}`);
    this._worst.style.left = `${(100 * Math.min(1, most)).toFixed(1)}%`;
    if (flow === undefined) return;
    write(this._missed, `worst ${durationText(worst)} · missed ${missed} · late ${durationText(Math.max(0, lateness))}`);
    this._missed.classList.toggle("a3-bad", most > 1);
    const { drawn, size, longest, received, delay, stalled } = flow;
    const wait = stalled ? ` · no frame for ${stalled.toFixed(1)} s` : ` · ${(1e3 * delay).toFixed(0)} ms behind`;
    write(this._flow, `picture ${drawn.toFixed(0)}/s${size} (longest ${(1e3 * longest).toFixed(0)} ms) · frames ${received}/s${wait}`);
  }
}
