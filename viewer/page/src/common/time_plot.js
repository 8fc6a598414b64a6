// Lines over time, with a line at the time that is shown; all diagrams of all pages.
import uPlot from "uplot";
import uplotStyle from "uplot/dist/uPlot.min.css";
import { styled } from "../styles.js";
import { el } from "./dom.js";

/** Okabe and Ito's palette: distinguishable with any colour vision. */
export const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#8a8f94"];
const FONT = "11px system-ui, sans-serif";
const FAINT = { stroke: "#8884", width: 1 };
// A canvas takes the word currentColor for black.
const INK = (/** @type {uPlot} */ plot) => getComputedStyle(plot.root).color;
const AXIS = { stroke: INK, grid: FAINT, ticks: FAINT, font: FONT, labelFont: FONT, labelSize: 16 };

/** @typedef {{width: number, height: number, series: uPlot.Series[], axes: uPlot.Axis[]} & Partial<uPlot.Options>} PlotOptions */

/** A diagram. */
export class TimePlot {
  /**
   * @param {HTMLElement} box - Takes it; its colour is that of the axes.
   * @param {uPlot.AlignedData} data - Times and values.
   * @param {PlotOptions} options - Series without that of the time.
   */
  constructor(box, data, { series, axes, scales, hooks, ...more }) {
    styled(uplotStyle);
    const [x, y] = axes;
    this.time = NaN;
    this.line = el("div.a3-now", {
      style: "position:absolute;top:0;bottom:0;width:0;border-left:1.5px solid var(--accent, #8888);pointer-events:none;display:none",
    });
    this.plot = new uPlot(
      {
        legend: { show: false },
        ...more,
        scales: { x: { time: false, ...scales?.x } },
        axes: [{ ...AXIS, ...x }, { ...AXIS, ...y }],
        series: [{}, ...series],
        hooks: { ...hooks, draw: [() => this.at(this.time)] },
      },
      data,
      box,
    );
    this.plot.over.append(this.line);
    this.at(this.time);
  }

  /** Put the line to a time. @param {number} time s */
  at(time) {
    this.time = time;
    const left = this.plot?.valToPos(time, "x");
    this.line.style.display = left >= 0 && left <= this.plot.over.clientWidth ? "" : "none";
    this.line.style.transform = `translateX(${left}px)`;
  }

  dispose() {
    this.plot.destroy();
  }
}
