// What colours, arrows and grid mean: small tables over the picture.
import { gradient } from "../looks/colour_map.js";
import { worded } from "./forces.js";

const BOX = "background:#ffffffd9;border-radius:4px;padding:5px 8px;font-variant-numeric:tabular-nums";

/** The legends of a view; each is written again only when it changes. */
export class Legends {
  #texts = new Map();

  /** @param {HTMLElement} layer takes the boxes */
  constructor(layer) {
    this.layer = layer;
  }

  /** Lines of text under a name; no lines take the box away. @param {string} name @param {string} html */
  put(name, html) {
    if ((this.#texts.get(name) ?? "") === html) return;
    this.#texts.set(name, html);
    let box = this.layer.querySelector(`[data-legend="${name}"]`);
    if (!html) {
      box?.remove();
      return;
    }
    if (box === null) {
      box = document.createElement("div");
      box.dataset.legend = name;
      box.style.cssText = BOX;
      this.layer.append(box);
    }
    box.innerHTML = html;
  }
}

/**
 * The legend of stress colours.
 * @param {{known: boolean, most: number, unit: string, limit: number | null, limitName: string, factor: number}} state
 */
export function stressLegend({ known, most, unit, limit, limitName, factor }) {
  if (!known) return "stress: not computed";
  const [full, name] = worded(most, unit).split(" ");
  const ticks = [0, 0.25, 0.5, 0.75, 1].map((level) => `<span>${Number((level * full).toPrecision(3))}</span>`).join("");
  const permitted = limit ? `<div>${limitName}: ${worded(limit, unit)}</div>` : "";
  return (
    `<div>stress in ${name}, deformation \u00d7${Number(factor.toPrecision(3))}</div>` +
    `<div style="width:190px;height:11px;margin:3px 0;background:${gradient()}"></div>` +
    `<div style="display:flex;justify-content:space-between">${ticks}</div>${permitted}`
  );
}

/** The legend of the arrows. @param {{unit: string, metres: number, value: number, colour: string}[]} scales */
export function arrowLegend(scales) {
  return scales
    .map(({ unit, metres, value, colour }) => `<div><b style="color:${colour}">\u2192</b> ${metres} m = ${worded(value, unit)}</div>`)
    .join("");
}
