// The times of all steps of the run: a histogram and its figures.
import { button, el, short, svg } from "../common/dom.js";

const [WIDTH, HEIGHT, FOOT] = [300, 120, 16];
/** Bars of a decade. */
const FINE = 12;

/** Counts by the decimal logarithm of the lower end of a bar. */
function grouped(bins) {
  const bars = new Map();
  const known = bins.filter(([edge, count]) => count > 0 && edge > 0);
  for (const [edge, count] of known) {
    const place = Math.floor(Math.log10(edge * (1 - 1e-6)) * FINE) / FINE;
    bars.set(place, (bars.get(place) ?? 0) + count);
  }
  return bars;
}

/**
 * Bars of a histogram, both axes by powers of ten.
 * @param {[number, number][]} bins - Upper edge, s (null: no edge), and count.
 * @param {number} deadline - s.
 */
export function histogram(bins, deadline) {
  const drawing = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "a3-histogram", "data-a3": "histogram" });
  const bars = grouped(bins);
  if (!bars.size) return drawing;
  const places = [...bars.keys(), Math.log10(deadline)];
  const [low, high] = [Math.min(...places) - 1 / FINE, Math.max(...places) + 1.5 / FINE];
  const at = (seconds) => (WIDTH * (Math.log10(seconds) - low)) / (high - low);
  const most = Math.log10(Math.max(...bars.values())) + 0.3;
  for (const [place, count] of bars) {
    const size = ((Math.log10(count) + 0.3) / most) * (HEIGHT - FOOT - 4);
    const fill = 10 ** place >= deadline ? "#e8412d" : "#4d9de0";
    const width = (0.9 * WIDTH) / FINE / (high - low);
    drawing.append(svg("rect", { x: at(10 ** place), y: HEIGHT - FOOT - size, width, height: size, fill }));
  }
  for (let power = Math.ceil(low); power <= high; power++) {
    drawing.append(label(at(10 ** power), `${power >= -3 ? short(1e3 * 10 ** power) : short(1e6 * 10 ** power)} ${power >= -3 ? "ms" : "µs"}`));
  }
  const x = at(deadline);
  drawing.append(svg("line", { x1: x, x2: x, y1: 0, y2: HEIGHT - FOOT, stroke: "#e8412d", "stroke-dasharray": "3 2" }));
  return drawing;
}

function label(x, text) {
  const made = svg("text", { x, y: HEIGHT - 4, "font-size": 9, "text-anchor": "middle", fill: "currentColor" });
  made.textContent = text;
  return made;
}

/** The panel of the report. */
export class Report {
  /** @param {() => void} ask - For a new one. */
  constructor(ask) {
    this._body = el("div", { data: "report" }, el("p.a3-hint", {}, "The times of all steps so far: press the button."));
    this.element = el("div", {}, button("ask report", "Report now", ask, "times of the steps of this run"), this._body);
  }

  /** @param {Data} report - Of the program, times in s. */
  show({ step, steps, simulated, wall, missed, skipped = 0, cost, lateness }) {
    if (!steps) return this._body.replaceChildren(el("p.a3-hint", {}, "No step was computed yet."));
    const spread = ({ median, p99, p999, largest }) => `${[median, p99, p999, largest].map(milli).join(" · ")} ms`;
    const rows = [
      ["steps", `${steps} of ${milli(step)} ms`],
      ["simulated / wall", `${simulated.toFixed(2)} s / ${wall.toFixed(2)} s`],
      ["missed deadlines", `${missed} (${short((100 * missed) / steps)} %)`],
      ["moved on", skipped ? `${skipped} times, because it was too late` : "never"],
      ["", "median · p99 · p99.9 · largest"],
      ["cost of a step", spread(cost)],
      ["late by", spread(lateness)],
    ].map(([name, words]) => el("tr", {}, el("th", {}, name), el("td", {}, words)));
    return this._body.replaceChildren(histogram(cost.bins, step), el("table", {}, ...rows));
  }
}

/** A time, ms. */
function milli(seconds) {
  return String(Number((1e3 * seconds).toPrecision(2)));
}
