// Sentences and legends over the picture.

/** The layer over a picture that says what is not drawn and what colours and arrows mean. */
export class Notes {
  #said = new Set();

  /** @param {HTMLElement} container @param {(sentence: string) => void} [listener] */
  constructor(container, listener) {
    this.listener = listener;
    this.layer = document.createElement("div");
    this.layer.className = "ali3-notes";
    this.layer.style.cssText =
      "position:absolute;inset:0;pointer-events:none;overflow:hidden;font:12px/1.35 system-ui,sans-serif;color:#1d2328";
    this.list = document.createElement("div");
    this.list.style.cssText = "position:absolute;left:8px;bottom:8px;max-width:60%";
    this.legend = document.createElement("div");
    this.legend.style.cssText = "position:absolute;right:8px;bottom:8px;display:flex;flex-direction:column;gap:6px;align-items:flex-end";
    this.layer.append(this.list, this.legend);
    container.append(this.layer);
  }

  /** @param {boolean} wanted whether sentences stand over the picture; they are said to the listener in any case */
  words(wanted) {
    this.worded = wanted;
    this.list.style.display = wanted ? "" : "none";
  }

  /** Sentences that have been said. @returns {string[]} */
  get said() {
    return [...this.#said];
  }

  /** Say a sentence once. @param {string} sentence */
  tell(sentence) {
    if (this.#said.has(sentence)) return;
    this.#said.add(sentence);
    this.listener?.(sentence);
    const line = document.createElement("div");
    line.textContent = sentence;
    line.style.cssText = "background:#fffc;border-radius:3px;padding:1px 6px;margin-top:3px;width:fit-content";
    if (this.list.childElementCount < 6) this.list.append(line);
  }

  /** A sentence in place of the picture, or none. @param {string} sentence */
  instead(sentence) {
    this.cover?.remove();
    if (!sentence) return;
    this.cover = document.createElement("div");
    this.cover.textContent = sentence;
    this.cover.setAttribute("role", "alert");
    this.cover.style.cssText =
      "position:absolute;inset:0;display:grid;place-items:center;padding:10%;text-align:center;background:#eef1f3;font-size:15px";
    this.layer.append(this.cover);
  }

  dispose() {
    this.layer.remove();
  }
}
