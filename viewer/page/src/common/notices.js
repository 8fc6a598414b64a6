// What there is to say: states that hold, over the picture, and events, which fade.
import { el, write } from "../common/dom.js";

/** Events on the screen, and for how long, s. */
const [MOST, LASTS] = [4, 7];

/** Sentences over the picture. */
export class Notices {
  constructor() {
    this._flags = new Map();
    this._ends = new WeakMap(); // timers by line
    this._list = el("div.a3-flags", { data: "flags" });
    this._events = el("div.a3-events", { data: "events" });
    this.element = el("div.a3-notices", {}, this._list, this._events);
  }

  /**
   * A state: it stands there while its text is not empty.
   * @param {string} name @param {string} text @param {"" | "bad"} [kind]
   */
  flag(name, text, kind = "") {
    let line = this._flags.get(name);
    if (!line) {
      if (!text) return;
      line = el("div", { data: `flag ${name}` });
      this._flags.set(name, line);
      this._list.append(line);
    }
    write(line, text);
    line.hidden = !text;
    line.classList.toggle("a3-bad", kind === "bad");
  }

  /** Something has happened. @param {string} text */
  tell(text) {
    if (!text) return;
    const last = this._events.lastElementChild;
    const line = last?.textContent === text ? last : el("div", {}, text);
    this._events.append(line);
    while (this._events.childElementCount > MOST) this._events.firstElementChild.remove();
    clearTimeout(this._ends.get(line));
    this._ends.set(line, setTimeout(() => line.remove(), 1000 * LASTS));
  }
}
