// Overlays of a picture of a scene: legends, labels and notices.
import { el } from "../common/dom.js";
import { instead } from "../common/notices.js";

/** The layer over a picture; sentences on parts that are not drawn are passed to a listener. */
export class Notes {
  _said = new Set();

  /** @param {HTMLElement} container @param {(sentence: string) => void} [listener] */
  constructor(container, listener) {
    this.listener = listener;
    const corner = "position:absolute;top:var(--a3-top,auto);right:var(--a3-right,8px);bottom:var(--a3-bottom,8px);max-width:var(--a3-wide,50%)";
    this.legend = el("div", { style: `${corner};display:flex;flex-direction:column;gap:6px;align-items:flex-end` });
    const style = "position:absolute;inset:0;pointer-events:none;overflow:hidden;font:12px/1.35 system-ui,sans-serif;color:#1d2328";
    this.layer = el("div.a3-notes", { style }, this.legend);
    container.append(this.layer);
  }

  /** All sentences so far. @returns {string[]} */
  get said() {
    return [...this._said];
  }

  /** Passes a sentence to the listener once. @param {string} sentence */
  tell(sentence) {
    if (this._said.has(sentence)) return;
    this._said.add(sentence);
    this.listener?.(sentence);
  }

  /** Shows a sentence in place of the picture; empty: none. @param {string} sentence */
  instead(sentence) {
    instead(this.layer, "not drawn", sentence);
  }

  dispose() {
    this.layer.remove();
  }
}
