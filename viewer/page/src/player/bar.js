// The bar below the picture: slider, buttons, speed, camera, and a panel of settings.
import { el, icon } from "../common/dom.js";
import { hint } from "../common/key_table.js";
import { SPEEDS } from "./clock.js";

/** The bar; it asks the player and tells it. */
export class Bar {
  /** @param {HTMLElement} parent @param {Data} player */
  constructor(parent, player) {
    this.player = player;
    const { clock } = player;
    const { t } = player.runs[0];
    this.digits = digitsOf((t[t.length - 1] - t[0]) / Math.max(1, t.length - 1));
    const button = (name, title, onclick) => el("button", { title, "aria-label": title, onclick }, icon(name));
    this.playing = button("play", hint("toggle"), () => player.toggle());
    this.slide = el("input.ali3-slide", {
      type: "range",
      "aria-label": "time",
      min: clock.begin,
      max: clock.end,
      step: "any",
      oninput: () => player.seek(Number(this.slide.value)),
    });
    this.time = el("span.ali3-time");
    this.speed = el("select", { title: `speed: ${hint("faster")}, ${hint("slower")}`, "aria-label": "speed", onchange: () => player.speed(Number(this.speed.value)) });
    this.speeds(clock.speed);
    const moves = clock.end > clock.begin;
    this.slide.disabled = !moves;
    parent.append(
      el(
        "div.ali3-group",
        {},
        button("back", hint("before"), () => player.step(-1)),
        this.playing,
        button("forward", hint("after"), () => player.step(1)),
      ),
      this.slide,
      this.time,
      el("div.ali3-group", {}, this.speed),
      el("div.ali3-group", {}, ...this.#views()),
    );
    /** @type {NodeListOf<HTMLButtonElement>} */
    const buttons = parent.querySelectorAll(".ali3-group:first-child button");
    for (const control of [...buttons, this.speed]) control.disabled = !moves;
    this.now();
  }

  #views() {
    const { player } = this;
    const made = [];
    if (player.cameras.length > 1) {
      this.camera = el("select", { title: `camera: ${hint("next camera")}`, "aria-label": "camera", onchange: () => player.camera(this.camera.value) });
      this.camera.append(...player.cameras.map((name) => el("option", { value: name }, name)));
      made.push(this.camera);
    }
    this.signals = el("button", { title: hint("panels"), onclick: () => player.side(!player.sideOpen) }, "signals");
    this.settings = el("button", { title: hint("settings"), "aria-haspopup": "true", onclick: () => player.settings.toggle() }, "settings");
    made.push(this.signals, this.settings);
    made.push(el("button", { title: hint("help"), "aria-label": "keys", onclick: () => player.help.toggle() }, "?"));
    if (document.fullscreenEnabled) {
      const full = el("button", { title: hint("full screen"), "aria-label": "full screen", onclick: () => player.fullScreen() }, icon("full"));
      made.push(full);
    }
    return made;
  }

  /** @param {number} chosen speed, which may be another than those of the list */
  speeds(chosen) {
    const all = [...new Set([...SPEEDS, chosen])].sort((a, b) => a - b);
    this.speed.replaceChildren(...all.map((speed) => el("option", { value: speed }, `${speed}×`)));
    this.speed.value = String(chosen);
  }

  /** Show the time and how it passes. */
  now() {
    const { clock } = this.player;
    this.slide.value = String(clock.time);
    this.time.textContent = `${clock.time.toFixed(this.digits)} / ${clock.end.toFixed(this.digits)} s`;
    if (this.shown !== clock.playing) {
      this.shown = clock.playing;
      this.playing.replaceChildren(icon(clock.playing ? "pause" : "play"));
    }
  }
}

/** Digits of a time so that each recorded one differs from the next. @param {number} step s */
export function digitsOf(step) {
  return step > 0 ? Math.min(9, Math.max(2, Math.ceil(-Math.log10(step) - 1e-3))) : 3;
}
