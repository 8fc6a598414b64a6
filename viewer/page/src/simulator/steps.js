// How the simulation keeps its time: the step against its deadline, simulated over wall time, frames of the page.
import { el, short, write } from "../common/dom.js";
import { paceWords } from "../live/hud.js";
import { Gauge } from "../instruments/gauges.js";

/** Span over which simulated time is compared with the clock, s. */
const SPAN = 1.0;
const micro = (seconds) => (seconds < 9.995e-4 ? `${(1e6 * seconds).toFixed(0)} µs` : `${(1e3 * seconds).toFixed(seconds < 0.01 ? 2 : 0)} ms`);

/** Simulated seconds per second of the host's clock, from its frames. */
export class Factor {
  constructor() {
    this._marks = [];
  }

  /** @param {Data} frame @returns {number | null} null while it is too short to tell */
  add({ epoch, running, speed, time, wall }) {
    const before = this._marks[this._marks.length - 1];
    if (!running || (before && (before.epoch !== epoch || before.speed !== speed))) this._marks = [];
    if (!running) return null;
    this._marks.push({ epoch, speed, time, wall });
    while (this._marks.length > 2 && wall - this._marks[1].wall >= SPAN) this._marks.shift();
    const [first] = this._marks;
    return wall - first.wall < 0.5 * SPAN ? null : (time - first.time) / (wall - first.wall);
  }
}

/** Figures of time. */
export class Steps {
  /** @param {number} step - Communication step, s. */
  constructor(step) {
    this._step = step;
    this._factor = new Factor();
    this.factor = null;
    this._time = el("div", { data: "time" });
    this._pace = el("div", { data: "pace" });
    this._bar = new Gauge({ data: "step time", colour: "#59d07a" });
    this._worst = el("u", { title: "the longest step of the last second" });
    this._bar.element.append(this._worst);
    this._missed = el("div", { data: "missed" });
    this._page = el("div", { data: "flow" });
    this.element = el("div.a3-steps", { data: "steps" }, this._time, this._pace, this._bar.element, this._missed, this._page);
  }

  /** A frame has come. */
  add(frame) {
    this.factor = this._factor.add(frame);
  }

  /** @returns {string} A warning where the host does not keep up. */
  show(frame, time, { drawn, size, longest, received, delay, stalled }) {
    const { running, speed, cost, worst, deadline, missed, lateness } = frame;
    write(this._time, `${time.toFixed(2)} s`);
    const { text, warn } = paceWords({ running, speed, factor: this.factor, cost: 0, step: this._step });
    write(this._pace, text);
    const share = deadline > 0 ? cost / deadline : 0;
    const most = deadline > 0 ? worst / deadline : 0;
    this._bar.show(share, share > 1 ? "#ff5a4d" : share > 0.5 ? "#ffb03b" : undefined);
    this._bar.words(`step ${micro(cost)} of ${micro(deadline)}`);
    this._worst.style.left = `${(100 * Math.min(1, most)).toFixed(1)}%`;
    write(this._missed, `worst ${micro(worst)} · missed ${missed} · late ${micro(Math.max(0, lateness))}`);
    this._missed.classList.toggle("a3-bad", most > 1);
    const wait = stalled ? ` · no frame for ${stalled.toFixed(1)} s` : ` · ${(1e3 * delay).toFixed(0)} ms behind`;
    write(this._page, `picture ${drawn.toFixed(0)}/s${size} (longest ${(1e3 * longest).toFixed(0)} ms) · frames ${received}/s${wait}`);
    return running ? warn || (frame.behind ? `The car's program is behind: ${this.factor === null ? "" : `${short(this.factor)} s of the run a second, `}${short(speed)} asked for.` : "") : "";
  }
}
