// Notices over pictures, the same on all pages: states that hold, events, which fade, and notes, which stay.
import { el } from "./dom.js";
import { styled } from "../styles.js";
import style from "./notices.css";

/** Events and notes on the screen, and how long events stay, s. */
const [EVENTS, NOTES, LASTS] = [4, 4, 7];

/** A sentence without its numbers. @param {string} text */
const wordsOf = (text) => text.replace(/[\d.]+/g, "");

/** Sentences over a picture; programs that read pages aloud say them as they come. */
export class Notices {
  /** All notes. @type {string[]} */
  noted = [];

  constructor() {
    styled(style);
    this._flags = new Map();
    this._ends = new WeakMap(); // timers by line
    this._list = el("div.a3-flags", { data: "flags" });
    this._notes = el("div.a3-noted", { data: "notes", role: "log" });
    this._events = el("div.a3-events", { data: "events", role: "log" });
    this.element = el("div.a3-notices", {}, this._list, this._notes, this._events);
  }

  /**
   * A state: it stands there while its text is not empty.
   * @param {string} name @param {string} text
   * @param {{bad?: boolean, choices?: HTMLElement[]}} [how] `choices`: buttons behind the sentence
   */
  flag(name, text, { bad = false, choices = [] } = {}) {
    let line = this._flags.get(name);
    if ((line?.text ?? "") === text) return;
    if (line === undefined) {
      // Its numbers may change all the time, which nobody wants to hear: they are no addition.
      const box = el("div", { data: `flag ${name}`, role: bad ? "alert" : "status", "aria-relevant": "additions" });
      line = { box, text: "" };
      this._flags.set(name, line);
      this._list.append(box);
    }
    const same = wordsOf(line.text) === wordsOf(text);
    line.text = text;
    line.box.hidden = !text;
    line.box.classList.toggle("a3-bad", bad);
    if (same && !choices.length) line.box.firstChild.data = text;
    else line.box.replaceChildren(text, ...choices);
  }

  /** States are over. @param {Iterable<string>} [names] by default all */
  lower(names = this._flags.keys()) {
    for (const name of names) this.flag(name, "");
  }

  /** Something has happened. @param {string} text */
  tell(text) {
    if (!text) return;
    const last = this._events.lastElementChild;
    const line = last?.textContent === text ? last : el("div", {}, text);
    this._events.append(line);
    while (this._events.childElementCount > EVENTS) this._events.firstElementChild.remove();
    clearTimeout(this._ends.get(line));
    this._ends.set(line, setTimeout(() => line.remove(), 1000 * LASTS));
  }

  /** Something that stays as it is; said once. @param {string} text */
  note(text) {
    if (this.noted.includes(text)) return;
    this.noted.push(text);
    const more = this.noted.length - NOTES;
    if (more > 1) this._notes.lastElementChild.remove();
    this._notes.append(el("div", {}, more > 0 ? `${more} more ${more > 1 ? "notes stand" : "note stands"} in the settings.` : text));
  }
}

/**
 * A sentence in place of what cannot be shown, or not yet.
 * @param {HTMLElement} box takes it @param {string} data name for programs @param {string} sentence empty takes it away
 */
export function instead(box, data, sentence) {
  styled(style);
  box.querySelector(":scope > .a3-instead")?.remove();
  if (sentence) box.append(el("p.a3-instead", { data, role: "alert" }, sentence));
}
