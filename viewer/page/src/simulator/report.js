// Statistics of the times of all steps of the run: a histogram and a table.
import { button, el, short, svg } from "../common/dom.js";

/** Size of the histogram, and its margins on the left and below, in units of the drawing. */
const [WIDTH, HEIGHT, LEFT, BOTTOM] = [300, 150, 40, 26];
/** Bars per decade. */
const BARS_PER_DECADE = 12;

/** Counts of bars, by the decimal logarithm of the bar's lower end. @param {[number, number][]} bins upper edge, s, and count */
function barCounts(bins) {
  const bars = new Map();
  const nonempty = bins.filter(([edge, count]) => count > 0 && edge > 0);
  for (const [edge, count] of nonempty) {
    const bar = Math.floor(Math.log10(edge * (1 - 1e-6)) * BARS_PER_DECADE) / BARS_PER_DECADE;
    bars.set(bar, (bars.get(bar) ?? 0) + count);
  }
  return bars;
}

/**
 * A histogram with logarithmic axes.
 * @param {[number, number][]} bins upper edge, s (null: no edge), and count
 * @param {number} deadline length of a step, s
 * @returns {SVGElement}
 */
function histogram(bins, deadline) {
  const drawing = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "a3-histogram", "data-a3": "histogram" });
  const bars = barCounts(bins);
  if (!bars.size) return drawing;
  const logarithms = [...bars.keys(), Math.log10(deadline)];
  const [low, high] = [Math.min(...logarithms) - 1 / BARS_PER_DECADE, Math.max(...logarithms) + 1.5 / BARS_PER_DECADE];
  const at = (seconds) => LEFT + ((WIDTH - LEFT) * (Math.log10(seconds) - low)) / (high - low);
  const most = Math.log10(Math.max(...bars.values())) + 0.3;
  const [baseline, plotHeight] = [HEIGHT - BOTTOM, HEIGHT - BOTTOM - 4];
  const level = (count) => baseline - ((Math.log10(count) + 0.3) / most) * plotHeight;
  for (let power = 0; power <= most - 0.3; power++) {
    const y = level(10 ** power);
    drawing.append(line(LEFT, WIDTH, y, y, { "stroke-opacity": 0.25 }), label(LEFT - 3, y + 3, count(10 ** power), "end"));
  }
  for (const [bar, number] of bars) {
    const fill = 10 ** bar >= deadline ? "#e8412d" : "#4d9de0";
    const width = (0.9 * (WIDTH - LEFT)) / BARS_PER_DECADE / (high - low);
    drawing.append(svg("rect", { x: at(10 ** bar), y: level(number), width, height: baseline - level(number), fill }));
  }
  for (let power = Math.ceil(low); power <= high; power++) {
    const x = at(10 ** power);
    const words = power >= -3 ? `${short(1e3 * 10 ** power)} ms` : `${short(1e6 * 10 ** power)} µs`;
    drawing.append(line(x, x, baseline, baseline + 3), label(x, baseline + 12, words));
  }
  const x = at(deadline);
  drawing.append(line(LEFT, WIDTH, baseline, baseline), line(LEFT, LEFT, 0, baseline));
  drawing.append(line(x, x, 0, baseline, { stroke: "#e8412d", "stroke-dasharray": "3 2" }));
  drawing.append(label((LEFT + WIDTH) / 2, HEIGHT - 3, `cost of a step; the step of ${short(1e3 * deadline)} ms is dashed`));
  const steps = label(8, baseline / 2, "steps");
  steps.setAttribute("transform", `rotate(-90 8 ${baseline / 2})`);
  drawing.append(steps);
  return drawing;
}

/** A power of ten in short form, such as 10k. @param {number} value */
const count = (value) => (value < 1000 ? String(value) : value < 1e6 ? `${value / 1000}k` : `${value / 1e6}M`);

function line(x1, x2, y1, y2, more = {}) {
  return svg("line", { x1, x2, y1, y2, stroke: "currentColor", ...more });
}

function label(x, y, text, anchor = "middle") {
  const element = svg("text", { x, y, "font-size": 9, "text-anchor": anchor, fill: "currentColor" });
  element.textContent = text;
  return element;
}

/** The panel of the report. */
export class Report {
  /** @param {() => void} ask requests a report from the program */
  constructor(ask) {
    this._body = el("div", { data: "report" }, el("p.a3-hint", {}, "The times of all steps so far: press the button."));
    this.element = el("div", {}, button("ask report", "Report now", ask, "times of the steps of this run"), this._body);
  }

  /** Shows a report of the program. @param {Data} report times in s */
  show({ step, steps, simulated, wall, missed, missed_by: by, skipped = 0, cost, lateness }) {
    if (!steps) return this._body.replaceChildren(el("p.a3-hint", {}, "No step was computed yet."));
    const quantiles = ({ median, p99, p999, largest }) => `${[median, p99, p999, largest].map(milliseconds).join(" · ")} ms`;
    const rows = [
      ["steps", `${steps} of ${short(1e3 * step)} ms`],
      ["simulated / wall", `${simulated.toFixed(2)} s / ${wall.toFixed(2)} s`],
      ["missed deadlines", `${missed} (${short((100 * missed) / steps)} %)`],
      ...(missed && by ? [["late while", `the step ran ${by.ran} · other programs ran ${by.others} · the processor stood still ${by.stolen}`]] : []),
      ["moved on", skipped ? `${skipped} times, because it was too late` : "never"],
      ["", "median · p99 · p99.9 · largest"],
      ["cost of a step", quantiles(cost)],
      ["late by", quantiles(lateness)],
    ].map(([name, words]) => el("tr", {}, el(name ? "th" : "td", {}, name), el("td", {}, words)));
    return this._body.replaceChildren(histogram(cost.bins, step), el("table", {}, ...rows));
  }
}

/** A time in ms, with two digits. @param {number} seconds @returns {string} */
function milliseconds(seconds) {
  return String(Number((1e3 * seconds).toPrecision(2)));
}
