// Notices over pictures of all pages: current states, events, which disappear, and permanent notes.
import { el } from "./dom.js";
import { hasKeyboardFocus } from "./keys.js";
import { styled } from "../styles.js";
import style from "./notices.css";

/** Largest numbers of events and notes on the screen, and duration of events, s. */
const [MAX_EVENTS, MAX_NOTES, DURATION] = [4, 4, 7];

/** A sentence without its numbers. @param {string} text */
const wordsOf = (text) => text.replace(/[\d.]+/g, "");

/** Sentences over a picture; screen readers read new ones aloud. */
export class Notices {
  /** All notes. @type {string[]} */
  noted = [];
  /** Gets the focus when the notice that has it is hidden. @type {HTMLElement | undefined} */
  fallbackFocus = undefined;

  constructor() {
    styled(style);
    this._flags = new Map();
    this._ends = new WeakMap(); // timers by element
    this._list = el("div.a3-flags", { data: "flags" });
    this._notes = el("div.a3-noted", { data: "notes", role: "log" });
    this._events = el("div.a3-events", { data: "events", role: "log" });
    this.element = el("div.a3-notices", {}, this._list, this._notes, this._events);
  }

  /**
   * Shows a state while its text is not empty.
   * @param {string} name @param {string} text
   * @param {{bad?: boolean, choices?: HTMLElement[]}} [how] `choices`: buttons after the sentence
   */
  flag(name, text, { bad = false, choices = [] } = {}) {
    let line = this._flags.get(name);
    if ((line?.text ?? "") === text) return;
    if (line === undefined) {
      // Changing numbers are no additions, so that screen readers do not read them aloud.
      const box = el("div", { data: `flag ${name}`, role: bad ? "alert" : "status", "aria-relevant": "additions" });
      line = { box, text: "" };
      this._flags.set(name, line);
      this._list.append(box);
    }
    if (hasKeyboardFocus(line.box)) this.fallbackFocus?.focus();
    const same = wordsOf(line.text) === wordsOf(text);
    line.text = text;
    line.box.hidden = !text;
    line.box.classList.toggle("a3-bad", bad);
    if (same && !choices.length) line.box.firstChild.data = text;
    else line.box.replaceChildren(text, ...choices);
  }

  /** Hides states. @param {Iterable<string>} [names] by default all */
  lower(names = this._flags.keys()) {
    for (const name of names) this.flag(name, "");
  }

  /** Shows an event. @param {string} text */
  tell(text) {
    if (!text) return;
    const last = this._events.lastElementChild;
    const line = last?.textContent === text ? last : el("div", {}, text);
    this._events.append(line);
    while (this._events.childElementCount > MAX_EVENTS) this._events.firstElementChild.remove();
    clearTimeout(this._ends.get(line));
    this._ends.set(line, setTimeout(() => line.remove(), 1000 * DURATION));
  }

  /** Shows a permanent note once. @param {string} text */
  note(text) {
    if (this.noted.includes(text)) return;
    this.noted.push(text);
    const more = this.noted.length - MAX_NOTES;
    if (more > 1) this._notes.lastElementChild.remove();
    this._notes.append(el("div", {}, more > 0 ? `${more} more ${more > 1 ? "notes stand" : "note stands"} in the settings.` : text));
  }
}

/**
 * Shows a sentence in place of a picture that is missing or not ready.
 * @param {HTMLElement} box parent element @param {string} data name for programs @param {string} sentence empty: none
 */
export function instead(box, data, sentence) {
  styled(style);
  box.querySelector(":scope > .a3-instead")?.remove();
  if (sentence) box.append(el("p.a3-instead", { data, role: "alert" }, sentence));
}
