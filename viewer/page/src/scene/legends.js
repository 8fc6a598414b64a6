// What colours, arrows and grid mean: small tables over the picture.
import { gradient } from "../looks/colour_map.js";
import { el } from "../common/dom.js";
import { parted, worded } from "./forces.js";

const BOX = "background:#ffffffd9;border-radius:4px;padding:5px 8px;font-variant-numeric:tabular-nums";

/** The legends of a view; each is made again only when it changes. */
export class Legends {
  #states = new Map();

  /** @param {HTMLElement} layer takes the boxes */
  constructor(layer) {
    this.layer = layer;
  }

  /**
   * Show a state under a name; none takes the box away.
   * @param {string} name
   * @param {Data | string | null} state
   * @param {(state: any) => (Node | string)[]} draw
   */
  put(name, state, draw) {
    const key = JSON.stringify(state);
    if (this.#states.get(name)?.key === key) return;
    this.#states.get(name)?.box?.remove();
    const box = state === null ? null : el("div", { style: BOX }, ...draw(state));
    this.#states.set(name, { key, box });
    if (box === null) return;
    box.dataset.legend = name;
    this.layer.append(box);
  }
}

/**
 * The legend of stress colours.
 * @param {{known: boolean, computed: boolean, most: number, unit: string, limit: number | null, limitName: string, factor: number}} state
 */
export function stressLegend({ known, computed, most, unit, limit, limitName, factor }) {
  if (!known) return [computed ? "stress: no numbers" : "stress: not computed"];
  const [full, name] = parted(most, unit);
  const ticks = [0, 0.25, 0.5, 0.75, 1].map((level) => el("span", {}, String(Number((level * full).toPrecision(3)))));
  return [
    el("div", {}, `stress in ${name}, deformation \u00d7${Number(factor.toPrecision(3))}`),
    el("div", { style: `width:190px;height:11px;margin:3px 0;background:${gradient()}` }),
    el("div", { style: "display:flex;justify-content:space-between" }, ...ticks),
    ...(limit ? [el("div", {}, `${limitName}: ${worded(limit, unit)}`)] : []),
  ];
}

/** The legend of the arrows. @param {{unit: string, metres: number, value: number, colour: string}[]} scales */
export function arrowLegend(scales) {
  return scales.map(({ unit, metres, value, colour }) =>
    el("div", {}, el("b", { style: `color:${colour}` }, "\u2192"), ` ${metres} m = ${worded(value, unit)}`),
  );
}
