// Sentences and legends over the picture.
import { el } from "../common/dom.js";

/** The layer over a picture that says what is not drawn and what colours and arrows mean. */
export class Notes {
  _said = new Set();

  /** @param {HTMLElement} container @param {(sentence: string) => void} [listener] */
  constructor(container, listener) {
    this.listener = listener;
    const column = "display:flex;flex-direction:column;gap:6px;align-items:flex-end";
    this.list = el("div", { style: column });
    this.legend = el("div", { style: column });
    const corner = el("div", { style: `position:absolute;top:var(--a3-top,auto);right:var(--a3-right,8px);bottom:var(--a3-bottom,8px);max-width:var(--a3-wide,50%);${column}` }, this.list, this.legend);
    const style = "position:absolute;inset:0;pointer-events:none;overflow:hidden;font:12px/1.35 system-ui,sans-serif;color:#1d2328";
    this.layer = el("div.a3-notes", { style }, corner);
    container.append(this.layer);
  }

  /** @param {boolean} wanted whether sentences stand over the picture; they are said to the listener in any case */
  words(wanted) {
    this.worded = wanted;
    this.list.style.display = wanted ? "flex" : "none";
  }

  /** Sentences that have been said. @returns {string[]} */
  get said() {
    return [...this._said];
  }

  /** Say a sentence once. @param {string} sentence */
  tell(sentence) {
    if (this._said.has(sentence)) return;
    this._said.add(sentence);
    this.listener?.(sentence);
    const style = "background:#fffc;border-radius:3px;padding:1px 6px";
    if (this.list.childElementCount < 6) this.list.append(el("div", { style }, sentence));
  }

  /** A sentence in place of the picture, or none. @param {string} sentence */
  instead(sentence) {
    this.cover?.remove();
    if (!sentence) return;
    const style = "position:absolute;inset:0;display:grid;place-items:center;padding:10%;text-align:center;background:#eef1f3;font-size:15px";
    this.cover = el("div", { role: "alert", style }, sentence);
    this.layer.append(this.cover);
  }

  dispose() {
    this.layer.remove();
  }
}
