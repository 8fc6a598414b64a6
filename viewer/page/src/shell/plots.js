// The side of the page: a list of all signals to choose from, and a diagram for each unit of those chosen.
import { Chart, palette } from "./chart.js";
import { el } from "../common/dom.js";
import { byUnit, found, signalNames, unitOf } from "./series.js";

const LISTED = 300;
const LOWEST = 130; // pixels of a diagram

/** Signals and diagrams. */
export class Plots {
  /** @param {HTMLElement} parent @param {Data} player @param {string[]} chosen names at the start */
  constructor(parent, player, chosen) {
    this.player = player;
    this.runs = player.runs;
    this.names = signalNames(this.runs);
    this.chosen = chosen.filter((name) => this.names.includes(name));
    this.differences = new Set();
    this.colours = palette();
    this.charts = [];
    this.search = el("input", {
      type: "search",
      placeholder: `search ${this.names.length} signals`,
      "aria-label": "search signals",
      oninput: () => this.#list(),
      onfocus: () => this.#open(true),
    });
    this.opener = el("button", { title: "show or hide the list of signals", onclick: () => this.#open(this.list.hidden) }, "list");
    this.list = el("div.a3-list");
    this.area = el("div.a3-plots");
    parent.append(el("div.a3-find", {}, this.search, this.opener), this.list, this.area);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.area);
    this.#open(this.chosen.length === 0);
    this.#draw();
  }

  /** @param {string[]} names that are plotted from now on */
  choose(names) {
    this.chosen = names.filter((name) => this.names.includes(name));
    this.#list();
    this.#draw();
  }

  now() {
    for (const chart of this.charts) chart.now();
  }

  redraw() {
    for (const chart of this.charts) chart.redraw();
  }

  resize() {
    const { clientWidth, clientHeight } = this.area;
    if (clientWidth === 0 || this.charts.length === 0) return;
    const height = Math.max(LOWEST, (clientHeight - 6) / this.charts.length);
    for (const chart of this.charts) chart.resize(clientWidth - 14, height);
  }

  dispose() {
    this.observer.disconnect();
    for (const chart of this.charts) chart.dispose();
  }

  #open(open) {
    this.list.hidden = !open;
    this.opener.setAttribute("aria-pressed", String(open));
    if (open) this.#list();
  }

  #list() {
    if (this.list.hidden) return;
    const names = found(this.names, this.search.value);
    /** @type {HTMLElement[]} */
    const rows = names.slice(0, LISTED).map((name) => {
      const box = el("input", { type: "checkbox", onchange: () => this.#toggle(name) });
      box.checked = this.chosen.includes(name);
      const unit = el("span.a3-unit", {}, unitOf(name, this.runs));
      return el("label", {}, box, el("span.a3-signal", {}, name), unit);
    });
    if (names.length > LISTED) rows.push(el("div.a3-more", {}, `and ${names.length - LISTED} more; search for them`));
    if (names.length === 0) rows.push(el("div.a3-more", {}, "no signal has these words in its name"));
    this.list.replaceChildren(...rows);
  }

  #toggle(name) {
    this.chosen = this.chosen.includes(name) ? this.chosen.filter((other) => other !== name) : [...this.chosen, name];
    this.#draw();
    this.player.changed();
  }

  #draw() {
    for (const chart of this.charts) chart.dispose();
    this.area.replaceChildren();
    const zoomed = (from, range) => this.charts.forEach((chart) => chart !== from && chart.zoom(range));
    const compare = (unit, on) => {
      if (on) this.differences.add(unit);
      else this.differences.delete(unit);
      this.#draw();
    };
    this.charts = [...byUnit(this.chosen, this.runs)].map(
      ([unit, names]) =>
        new Chart(this.area, {
          unit,
          names,
          zoomed,
          compare,
          runs: this.runs,
          colours: this.colours,
          player: this.player,
          difference: this.differences.has(unit),
        }),
    );
    if (this.charts.length === 0) this.area.append(el("div.a3-empty", {}, "Choose signals from the list; a click in a diagram goes to that time."));
    this.resize();
  }
}
