// A diagram of the signals of one unit over time, of all runs, with a line at the current time.
import uPlot from "uplot";
import uplotStyle from "uplot/dist/uPlot.min.css";
import { el, write } from "../common/dom.js";
import { addKeys } from "../common/keys.js";
import { styled } from "../styles.js";
import { resampled, values } from "./series.js";

/** Okabe and Ito's palette: distinguishable with any colour vision. */
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#8a8f94"];
const FONT = "11px system-ui, sans-serif";
const GRID_STYLE = { stroke: "#8884", width: 1 };
// A canvas interprets currentColor as black.
const INK = (/** @type {uPlot} */ plot) => getComputedStyle(plot.root).color;
/** Magnitudes that are written without an exponent. */
const [SMALL, LARGE] = [1e-3, 1e9];
const DIGITS = 12;
const GROUPED = new Intl.NumberFormat("en", { maximumSignificantDigits: DIGITS }); // uPlot writes at most three decimals
/** Width of a character of a number at an axis, pixels. */
const CHARACTER = 6.3;

/** Texts of the numbers at an axis, all with an exponent where that is shorter. @param {number[]} ticks @returns {string[]} */
function tickTexts(ticks) {
  const plain = ticks.map((value) => GROUPED.format(value));
  const usual = ticks.every((value) => value === 0 || (Math.abs(value) >= SMALL && Math.abs(value) < LARGE));
  if (usual) return plain;
  const scientific = ticks.map((value) => (value === 0 ? "0" : Number(value.toPrecision(DIGITS)).toExponential()));
  return longest(scientific) < longest(plain) ? scientific : plain;
}

/** Number of characters of the longest text. @param {string[]} texts */
const longest = (texts) => Math.max(...texts.map(({ length }) => length));

/** Distance of ticks at which the times of a range do not overlap, pixels. @param {number} low s @param {number} high s */
function timeSpace(low, high) {
  const step = 10 ** Math.floor(Math.log10((high - low) / 4)); // about that of the ticks
  return 20 + CHARACTER * longest(tickTexts([low, high].map((time) => step * Math.round(time / step) + step)));
}

/** Range of an axis for values, wider than them; about a single value it is a tenth of it to both sides. @param {number | null} low @param {number | null} high @returns {uPlot.Range.MinMax} */
function heights(low, high) {
  if (low === null || low !== high) return low === null ? [null, null] : uPlot.rangeNum(low, high, MARGIN, true);
  const half = MARGIN * Math.abs(low) || 1;
  return [low - half, low + half];
}

const AXIS = {
  ...{ stroke: INK, grid: GRID_STYLE, ticks: GRID_STYLE, font: FONT, labelFont: FONT, labelSize: 16 },
  values: (/** @type {uPlot} */ plot, /** @type {number[]} */ ticks) => tickTexts(ticks),
};
const LINE = "position:absolute;top:0;bottom:0;width:0;border-left:1.5px solid var(--accent, #8888);pointer-events:none;display:none";
const DASHES = [[], [6, 4], [2, 3], [8, 3, 2, 3]];
const CURSOR_KEY = "ali3"; // common cursor of all diagrams
const KEY_ZOOM = 0.7; // factor of the shown span of time by a key
const MARGIN = 0.1; // of the range of an axis beyond its values
const NULL_RETAIN = 1; // of uPlot.join: retains gaps of a run

/** Text of a number. @param {number} value @returns {string} */
const numberText = (value) => (Number.isFinite(value) ? Number(value.toPrecision(5)).toString() : "–");

export class Chart {
  _isSettingScale = false;

  /**
   * @param {HTMLElement} parent
   * @param {{unit: string, names: string[], runs: Data[], colours: (name: string) => string, source: import("./shell.js").Source,
   *   zoomed: (chart: Chart, range: [number, number]) => void, axisWidth: (plot: uPlot, own: number) => number, difference: boolean,
   *   compare: (unit: string, on: boolean) => void}} options
   */
  constructor(parent, { unit, names, runs, colours, source, zoomed, axisWidth, difference, compare }) {
    this.unit = unit;
    this.names = names;
    this.runs = runs;
    this.colours = colours;
    this.source = source;
    this.zoomed = zoomed;
    this.axisWidth = axisWidth;
    this.difference = difference;
    this.compare = compare;
    this.curves = this._curves();
    this.legend = this._legend();
    this.box = el("div.a3-chart", {}, this.legend);
    parent.append(this.box);
    this.line = el("div.a3-now", { style: LINE });
    styled(uplotStyle);
    this.plot = new uPlot(this._settings(), this._data(), this.box);
    this.plot.over.append(this.line);
    this.plot.over.addEventListener("click", (event) => this._seekAt(event));
    const acts = { "+": () => this._narrow(KEY_ZOOM), "-": () => this._narrow(1 / KEY_ZOOM) };
    addKeys(this.plot.over, `diagram of ${names.join(", ")}`, acts);
  }

  /** Curves: {label, colour, dash, t, data}, and their `value` at the instant of a lookup of each run. */
  _curves() {
    const [first, ...others] = this.runs;
    const curves = [];
    for (const name of this.names) {
      const colour = this.colours(name);
      if (this.difference) {
        for (const [k, run] of others.entries()) {
          if (!(name in run.columns) || !(name in first.columns)) continue;
          const other = resampled(run.t, run.columns[name].data, first.t);
          const data = Array.from(first.columns[name].data, (v, i) => (other[i] === null || !Number.isFinite(v) ? null : other[i] - v));
          const value = (lookups) => lookups[k + 1](name) - lookups[0](name);
          curves.push({ label: `${name}: ${run.name} - ${first.name}`, colour, dash: DASHES[k % 4], t: first.t, data, value });
        }
        continue;
      }
      for (const [k, run] of this.runs.entries()) {
        if (!(name in run.columns)) continue;
        const label = this.runs.length > 1 ? `${name}, ${run.name}` : name;
        const value = (lookups) => lookups[k](name);
        curves.push({ label, colour, dash: DASHES[k % 4], t: run.t, data: values(run.columns[name].data), value });
      }
    }
    return curves;
  }

  _data() {
    if (this.curves.length === 0) return [this.source.range];
    const tables = new Map();
    for (const { t, data } of this.curves) tables.set(t, [...(tables.get(t) ?? [Array.from(t)]), data]);
    const lists = [...tables.values()];
    if (lists.length === 1) return lists[0];
    // Restores the order of the curves, which joining changes to that of the runs.
    const joined = uPlot.join(lists, lists.map((list) => list.map(() => NULL_RETAIN)));
    const at = new Map();
    let column = 1;
    for (const list of lists) for (const data of list.slice(1)) at.set(data, joined[column++]);
    return [joined[0], ...this.curves.map(({ data }) => at.get(data))];
  }

  /** @returns {uPlot.Options} */
  _settings() {
    const [min, max] = this.source.grows ? [] : this.source.range;
    return {
      width: 300,
      height: 140,
      padding: [6, 16, 0, 0],
      legend: { show: false },
      scales: { x: { time: false, range: (plot, low, high) => (low === high ? [low - 0.5, high + 0.5] : [low, high]), min, max }, y: { range: (plot, low, high) => heights(low, high) } },
      axes: [
        { ...AXIS, label: "time, s", size: 26, space: (plot, axis, low, high) => timeSpace(low, high) },
        { ...AXIS, label: this.unit || "1", size: (plot, labels) => this.axisWidth(plot, 14 + CHARACTER * longest(["   ", ...(labels ?? [])])) },
      ],
      series: [{}, ...this.curves.map(({ label, colour, dash, t }) => ({ label, stroke: colour, dash, width: 1.5, points: { show: t.length === 1 ? true : undefined } }))],
      cursor: { sync: { key: CURSOR_KEY }, drag: { x: true, y: false, dist: 6 }, points: { size: 6 } },
      hooks: {
        draw: [() => this._putLine()],
        setScale: [(plot, key) => key === "x" && !this._isSettingScale && this.zoomed(this, [plot.scales.x.min, plot.scales.x.max])],
      },
    };
  }

  _legend() {
    const entries = this.curves.map((curve) => {
      curve.output = el("output", { "aria-live": "off" }); // it changes in each picture
      const dashed = `repeating-linear-gradient(90deg, ${curve.colour} 0 4px, transparent 4px 6px)`;
      const style = `background:${curve.dash.length > 0 ? dashed : curve.colour}`;
      const swatch = el("span.a3-swatch", { style });
      return el("span", {}, swatch, curve.label, curve.output);
    });
    const legend = el("div.a3-legend", {}, ...entries);
    if (this.runs.length > 1) {
      const press = () => this.compare(this.unit, !this.difference);
      const title = "show the difference to the first run";
      legend.append(el("button", { title, "aria-pressed": String(this.difference), onclick: press }, "difference"));
    }
    return legend;
  }

  _seekAt(event) {
    const { select, over } = this.plot;
    if (select.width > 0) return; // the end of a zoom by dragging
    const left = event.clientX - over.getBoundingClientRect().left;
    this.source.acts.seek?.(this.plot.posToVal(left, "x"));
  }

  /** Updates the data of the curves. @param {Data[]} runs */
  refresh(runs) {
    this.runs = runs;
    const outputs = this.curves.map(({ output }) => output);
    this.curves = this._curves().map((curve, k) => ({ ...curve, output: outputs[k] }));
    this._isSettingScale = true;
    this.plot.setData(this._data());
    this._isSettingScale = false;
  }

  /** Moves the line to the current time. */
  _putLine() {
    const left = this.plot?.valToPos(this.source.time, "x");
    this.line.style.display = left >= 0 && left <= this.plot.over.clientWidth ? "" : "none";
    this.line.style.transform = `translateX(${left}px)`;
  }

  /** Updates the line and the values at the current time. */
  now() {
    const { time, grows } = this.source;
    this._putLine();
    const lookups = this.source.sample();
    for (const { t, value, output } of this.curves) {
      const inside = grows || (time >= t[0] && time <= t[t.length - 1]);
      write(output, `${numberText(inside ? value(lookups) : NaN)}${this.unit ? ` ${this.unit}` : ""}`);
    }
  }

  /** Shows a narrower or wider range of time around the current time. @param {number} factor of its length */
  _narrow(factor) {
    const { data: [t], scales: { x: { min, max } } } = this.plot; // prettier-ignore
    const [first, last] = [t[0], t.at(-1)];
    const centre = Math.min(last, Math.max(first, this.source.time));
    const within = (time) => Math.min(last, Math.max(first, centre + factor * (time - centre)));
    const range = { min: within(Math.min(min, centre)), max: within(Math.max(max, centre)) };
    if (range.max > range.min) this.plot.setScale("x", range);
  }

  /** Sets the range of time. @param {[number, number]} range s */
  zoom([min, max]) {
    this._isSettingScale = true;
    this.plot.batch(() => this.plot.setScale("x", { min, max }));
    this._isSettingScale = false;
  }

  /** Sets the size with legend. @param {number} width pixels @param {number} height pixels */
  resize(width, height) {
    const left = height - this.legend.offsetHeight - 2;
    this.plot.setSize({ width: Math.max(120, Math.floor(width)), height: Math.max(90, Math.floor(left)) });
    this.now();
  }

  /** Redraws after a change of the theme. */
  redraw() {
    this.plot.redraw(false, true);
  }

  dispose() {
    this.plot.destroy();
    this.box.remove();
  }
}

/** Function that gives names different colours, as far as there are enough. */
export function palette() {
  const groups = new Map();
  return (name) => {
    if (!groups.has(name)) groups.set(name, COLOURS[groups.size % COLOURS.length]);
    return groups.get(name);
  };
}
