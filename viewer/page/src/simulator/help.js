// The keys, over the picture.
import { el } from "../common/dom.js";

const KEYS = [
  ["← → or A D", "steer"],
  ["↑ or W", "throttle"],
  ["↓ or S", "brake"],
  ["Space", "hand brake"],
  ["R, N, Shift+D", "reverse, neutral, drive"],
  ["1 2 3 4 5, C", "driver, chase, wheels in turn, orbit, map; next camera"],
  ["P", "pause or run"],
  [".", "one communication step"],
  ["L", "slow motion"],
  ["Backspace", "rewind 2 s; with Shift 10 s"],
  ["U", "set upright"],
  ["Home", "reset: begin again"],
  ["F, B", "forces as arrows, colours of stress (where the car has them)"],
  ["X", "body closed, or see-through onto its frame (where the car has one)"],
  ["M", "sound on or off"],
  ["T", "levers for fingers"],
  ["G", "panels: devices, report, picture"],
  ["H or ?", "these keys"],
];

/** A table of the keys. */
export class Help {
  constructor() {
    const rows = KEYS.map(([key, words]) => el("tr", {}, el("th", {}, key), el("td", {}, words)));
    this.element = el("div.a3-help", { data: "help list", hidden: true }, el("table", {}, ...rows));
    this.element.addEventListener("click", () => this.toggle(false));
  }

  /** @param {boolean} [open] */
  toggle(open = this.element.hidden === true) {
    this.element.hidden = !open;
  }
}
