// Makes the legends of colours, arrows and grid over the picture.
import { gradient } from "../looks/colour_map.js";
import { el } from "../common/dom.js";
import { niceStep, parted, worded } from "./forces.js";

const BOX = "background:#ffffffd9;border-radius:4px;padding:5px 8px;font-variant-numeric:tabular-nums";

/** The legends of a view, remade only when they change. */
export class Legends {
  _states = new Map();

  /** @param {HTMLElement} layer parent of the legends */
  constructor(layer) {
    this.layer = layer;
  }

  /**
   * Shows a state as the legend of a name; null removes it.
   * @param {string} name
   * @param {Data | string | null} state
   * @param {(state: any) => (Node | string)[]} draw
   */
  put(name, state, draw) {
    const key = JSON.stringify(state);
    if (this._states.get(name)?.key === key) return;
    this._states.get(name)?.box?.remove();
    const box = state === null ? null : el("div", { style: BOX }, ...draw(state));
    this._states.set(name, { key, box });
    if (box === null) return;
    box.dataset.legend = name;
    this.layer.append(box);
  }
}

/**
 * Content of the legend of stress; `ends`: larger stress has the last colour.
 * @param {{known: boolean, computed: boolean, most: number, ends: boolean, unit: string, limit: number | null, limitName: string, factor: number}} state
 */
export function stressLegend({ known, computed, most, ends, unit, limit, limitName, factor }) {
  if (!known) return [computed ? "stress: no numbers" : "stress: not computed"];
  const [full, name] = parted(most, unit);
  const ticks = ticksTo(full).map((value) => el("span", { style: `position:absolute;left:${(100 * value) / full}%;transform:translateX(-50%)` }, `${ends && value === full ? "\u2265" : ""}${value}`));
  return [
    el("div", {}, `largest normal stress in ${name}, deformation \u00d7${Number(factor.toPrecision(3))}`),
    el("div", { style: `height:11px;margin:3px 10px;background:${gradient()}` }),
    el("div", { style: "position:relative;height:1.35em;margin:0 10px" }, ...ticks),
    ...(limit ? [el("div", {}, `${limitName}: ${worded(limit, unit)}`)] : []),
  ];
}

/** Round numbers from 0 to the end of the scale. @param {number} most */
function ticksTo(most) {
  const step = niceStep(most / 3);
  return Array.from({ length: Math.floor(most / step + 1e-9) + 1 }, (_, k) => Number((k * step).toPrecision(6)));
}

/** Content of the legend of arrows. @param {{unit: string, metres: number, value: number, colour: string}[]} scales */
export function arrowLegend(scales) {
  return scales.map(({ unit, metres, value, colour }) =>
    el("div", {}, el("b", { style: `color:${colour}` }, "\u2192"), ` ${metres} m = ${worded(value, unit)}`),
  );
}
