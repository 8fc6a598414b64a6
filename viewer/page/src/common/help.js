// The list of keys, shown over a page.
import { el } from "./dom.js";
import { ROWS } from "./key_table.js";
import { styled } from "../styles.js";
import style from "./help.css";

export class Help {
  /** @param {string[]} acts names of actions of the page @param {boolean} [drives] whether keys drive a car */
  constructor(acts, drives = false) {
    styled(style);
    const rows = ROWS.filter(({ act, codes }) => (codes ? drives : acts.includes(act)));
    const lines = rows.map(({ shown, words }) => el("div", {}, el("kbd", {}, shown), el("span", {}, words)));
    this.element = el("dialog.a3-help", { data: "help list", "aria-label": "keys" }, el("div", {}, ...lines));
    this.element.addEventListener("click", () => this.toggle(false));
  }

  /** @param {boolean} [open] */
  toggle(open = !this.element.open) {
    if (!open) this.element.close();
    else if (!this.element.open) this.element.showModal();
  }
}
