// Plots of chosen outputs, in step with the run.
import { button, el, named, select } from "../common/dom.js";
import { COLOURS, TimePlot } from "../common/time_plot.js";
import { section } from "./panel.js";

const MOST_POINTS = 1000;
const HEIGHT = 120;
/** @type {[number, string][]} */
const SPANS = [[10, "10 s"], [30, "30 s"], [120, "2 min"], [Infinity, "all"]];

/** The plots of the panel. */
export class Plots {
  /**
   * @param {string[]} names - Of inputs and outputs that can be chosen.
   * @param {Map<string, Data>} variables - For units and descriptions.
   * @param {string[]} first - Chosen at the start.
   */
  constructor(names, variables, first) {
    this._variables = variables;
    this._span = SPANS[0][0];
    this._plots = new Map();
    this._list = el("div");
    const choice = select("plot", "a signal that is plotted", [["", "plot …"], ...named(names)], (name) => {
      if (name) this.add(name);
      choice.value = "";
    });
    const span = select("span", "how much time the plots show", SPANS, (value) => {
      this._span = Number(value);
      this.stale = true;
    });
    this.element = section("Plots", true, el("div.a3-control", {}, choice, span), this._list);
    this._first = first;
    this.stale = true;
  }

  /** Make the first plots, once the panel has a width. */
  open() {
    for (const name of this._first) this.add(name);
  }

  /** Names that are plotted. */
  get names() {
    return [...this._plots.keys()];
  }

  /** Plot one more. */
  add(name) {
    if (this._plots.has(name)) return;
    const { unit = "1", description = "" } = this._variables.get(name) ?? {};
    const label = unit === "1" ? name : `${name}, ${unit}`;
    const close = button(`unplot ${name}`, "×", () => this.remove(name), "remove");
    const holder = el("div.a3-plot", { data: `plot ${name}` }, el("div.a3-name", { title: description }, label, close));
    this._list.append(holder);
    this._plots.set(name, { holder, plot: null });
    this.stale = true;
  }

  remove(name) {
    const found = this._plots.get(name);
    found?.plot?.dispose();
    found?.holder.remove();
    this._plots.delete(name);
  }

  /**
   * Draw what the run has been.
   * @param {import("./record.js").Record} record
   * @param {string[]} prefixes - Of the columns of each FMU.
   * @param {number} time - Of the picture, s; a line stands there.
   */
  show(record, prefixes, time) {
    this.stale = false;
    if (!this.element.open) return;
    const rows = Number.isFinite(this._span) ? Math.round(this._span / record.step) : record.end;
    const from = Math.max(record.first, record.end - rows);
    const stride = Math.max(1, Math.ceil((record.end - from) / MOST_POINTS));
    for (const [name, entry] of this._plots) {
      const columns = [...new Set(prefixes.map((p) => record.column(p + name)).concat(record.column(name)))];
      const series = columns.filter((c) => c >= 0).map((c) => record.series(c, from, stride));
      if (!series.length) continue;
      const data = [series[0][0], ...series.map(([, values]) => values)];
      entry.plot ??= this._make(entry.holder, series.length);
      entry.plot.plot.setData(data);
      entry.plot.at(time);
    }
  }

  _make(holder, count) {
    const series = COLOURS.slice(0, count).map((stroke, k) => ({ stroke, width: 1.2, dash: k ? [6, 3] : [] }));
    const options = { width: Math.max(120, holder.clientWidth - 4), height: HEIGHT, cursor: { show: false }, series, axes: [{ size: 22 }, { size: 52 }] };
    return new TimePlot(holder, [[], ...series.map(() => [])], options);
  }
}
