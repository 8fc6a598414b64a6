// The plots beside the picture: a list of all signals, and a diagram for each unit of the chosen ones.
import { Chart, palette } from "./chart.js";
import { el, select } from "../common/dom.js";
import { hasKeyboardFocus, show } from "../common/keys.js";
import { byUnit, found } from "./series.js";

const MAX_LISTED = 300;
const MIN_HEIGHT = 130; // pixels of a diagram
const DRAW_INTERVAL = 120; // least interval of drawing a live run, ms
/** Shown time spans of a live run, s. @type {[number, string][]} */
const SPANS = [[10, "10 s"], [30, "30 s"], [120, "2 min"], [Infinity, "all"]]; // prettier-ignore

export class Plots {
  span = SPANS[0][0];
  drawnAt = -Infinity;

  /**
   * @param {HTMLElement} parent @param {import("./shell.js").Shell} shell of the page
   * @param {import("./shell.js").Source} source @param {string[]} chosen names of initial signals
   */
  constructor(parent, shell, source, chosen) {
    this.shell = shell;
    this.source = source;
    this.names = [...source.columns.keys()];
    this.chosen = chosen.filter((name) => this.names.includes(name));
    this.differences = new Set();
    this.colours = palette();
    this.charts = [];
    this.search = el("input", {
      type: "search",
      placeholder: `search ${this.names.length} signals`,
      "aria-label": "search signals",
      oninput: () => (this.list.hidden ? this._open(true) : this._list()),
      onclick: () => this._open(true), // not on focus: the Tab key would then stop at every signal
    });
    this.opener = el("button", { title: "show or hide the list of signals", onclick: () => this._open(this.list.hidden) }, "list");
    this.list = el("div.a3-list", { hidden: true });
    this.area = el("div.a3-plots");
    const span = select("span", "how much time the diagrams show", SPANS, (value) => {
      this.span = Number(value);
      this.now(true);
    });
    parent.append(el("div.a3-find", {}, this.search, ...(source.grows ? [span] : []), this.opener), this.list, this.area);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.area);
    this._open(this.chosen.length === 0);
    this._draw();
  }

  /** Chooses the plotted signals. @param {string[]} names */
  choose(names) {
    this.chosen = names.filter((name) => this.names.includes(name));
    this._list();
    this._draw();
  }

  /** Shows the current time and new values of a live run. @param {boolean} [all] whether values are updated at once */
  now(all = false) {
    if (this.source.grows && (all || performance.now() - this.drawnAt > DRAW_INTERVAL)) {
      this.drawnAt = performance.now();
      const runs = this.source.plotted(this.chosen, this.span);
      for (const chart of this.charts) chart.refresh(runs);
    }
    for (const chart of this.charts) chart.now();
  }

  /**
   * Width of the left axes, which is that of the widest one, so that one instant is at one place in all diagrams.
   * @param {object} plot of a chart @param {number} own width that its numbers need, pixels
   */
  _axisWidth(plot, own) {
    this.axisWidths.set(plot, own);
    const width = Math.max(...this.axisWidths.values());
    if (width !== this.axisWidth) queueMicrotask(() => this.redraw());
    this.axisWidth = width;
    return width;
  }

  redraw() {
    for (const chart of this.charts) chart.redraw();
  }

  resize() {
    const { clientWidth, clientHeight } = this.area;
    if (clientWidth === 0 || this.charts.length === 0) return;
    const height = Math.max(MIN_HEIGHT, (clientHeight - 6) / this.charts.length);
    for (const chart of this.charts) chart.resize(clientWidth - 14, height);
  }

  dispose() {
    this.observer.disconnect();
    for (const chart of this.charts) chart.dispose();
  }

  _open(open) {
    const opens = open && this.list.hidden;
    show(this.list, open, this.opener);
    if (opens) this._list(); // rows of an open list stay, as one of them may have the focus
  }

  _list() {
    if (this.list.hidden) return;
    const names = found(this.names, this.search.value);
    /** @type {HTMLElement[]} */
    const rows = names.slice(0, MAX_LISTED).map((name) => {
      const box = el("input", { type: "checkbox", onchange: () => this._toggle(name) });
      box.checked = this.chosen.includes(name);
      const unit = el("span.a3-unit", {}, this.source.columns.get(name));
      return el("label", {}, box, el("span.a3-signal", {}, name), unit);
    });
    if (names.length > MAX_LISTED) rows.push(el("div.a3-more", {}, `and ${names.length - MAX_LISTED} more; search for them`));
    if (names.length === 0) rows.push(el("div.a3-more", {}, this.names.length > 0 ? "no signal has these words in its name" : "there are no signals"));
    this.list.replaceChildren(...rows);
  }

  _toggle(name) {
    this.chosen = this.chosen.includes(name) ? this.chosen.filter((other) => other !== name) : [...this.chosen, name];
    this._draw();
    this.shell.changed();
  }

  _draw() {
    for (const chart of this.charts) chart.dispose();
    this.axisWidths = new Map();
    this.area.replaceChildren();
    const zoomed = (from, range) => this.charts.forEach((chart) => chart !== from && chart.zoom(range));
    const compare = (unit, on) => {
      if (on) this.differences.add(unit);
      else this.differences.delete(unit);
      const refocus = hasKeyboardFocus(this.area);
      this._draw(); // removes the pressed button
      if (refocus) this.charts.find((chart) => chart.unit === unit).legend.querySelector("button").focus();
    };
    const runs = this.source.plotted(this.chosen, this.span);
    this.charts = [...byUnit(this.chosen, this.source.columns)].map(
      ([unit, names]) =>
        new Chart(this.area, {
          unit,
          names,
          zoomed,
          axisWidth: (plot, own) => this._axisWidth(plot, own),
          compare,
          runs,
          colours: this.colours,
          source: this.source,
          difference: this.differences.has(unit),
        }),
    );
    if (this.charts.length === 0) this.area.append(el("div.a3-empty", {}, "Choose signals from the list; a click in a diagram goes to that time."));
    this.resize();
  }
}
