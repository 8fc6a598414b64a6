// The panel of settings: forces, stress, ghosts, colours of the page, and notes.
import { QUALITIES } from "../looks/picture_quality.js";
import { el, named, select } from "../common/dom.js";
import { hint } from "../common/key_table.js";
import { show } from "../common/keys.js";

export class Settings {
  /** @param {HTMLElement} parent @param {Data} player the shell of the page @param {Data} source */
  constructor(parent, player, source) {
    this.player = player;
    this.source = source;
    /** Functions that show a value, by its name. */
    this.shown = {};
    this.notes = el("div.a3-wide");
    this.panel = el("div.a3-panel", { hidden: true });
    parent.append(this.panel);
    this._fill();
  }

  toggle(open = this.panel.hidden === true) {
    show(this.panel, open, this.player.bar.buttons.settings);
    this.notes.replaceChildren(...this.player.notices.noted.map((note) => el("p", {}, note)));
  }

  /** Shows values that were set elsewhere. @param {Data} look by name */
  refresh(look) {
    for (const [key, value] of Object.entries(look)) this.shown[key]?.(value);
  }

  _fill() {
    const { player } = this;
    const { look } = player;
    const rows = [];
    const check = (text, value, change, data = "") => {
      const box = el("input", { type: "checkbox", data, onchange: () => change(box.checked) });
      box.checked = value;
      rows.push(el("label.a3-wide", {}, box, ` ${text}`));
      return (now) => (box.checked = now === true || now?.length > 0);
    };
    // A slider of a factor with a logarithmic scale.
    const factor = (text, key, low, high) => {
      const shown = el("output");
      const range = el("input", { type: "range", min: Math.log10(low), max: Math.log10(high), step: 0.05, "aria-label": text });
      this.shown[key] = (value) => {
        shown.textContent = `${Number(value.toPrecision(3))}×`;
        range.value = String(Math.log10(Math.max(value, low)));
        range.setAttribute("aria-valuetext", shown.textContent); // in place of the logarithm
      };
      this.shown[key](look[key]);
      range.addEventListener("input", () => {
        const value = Number((10 ** Number(range.value)).toPrecision(3));
        player.setLook({ [key]: value });
      });
      rows.push(el("span", {}, text), range, shown);
      return (value) => player.setLook({ [key]: value });
    };
    const addSwitch = (effect) => {
      if (player.has[effect]) this.shown[effect] = check(hint(effect), look[effect], (on) => player.setLook({ [effect]: on }), `show ${effect}`);
    };
    const choice = (data, text, names, change, value) => {
      const box = select(data, text, named(names), change, value);
      rows.push(el("span", {}, text), box, el("span"));
      return (now) => (box.value = now);
    };
    addSwitch("arrows");
    if (player.has.arrows) factor("length of the arrows", "arrowScale", 0.1, 10);
    for (const effect of ["path", "closed", "stress"]) addSwitch(effect);
    if (player.has.deformation) {
      const deform = factor("deformation", "deformation", 1, 1000);
      const fit = () => deform(player.view.fittingDeformation);
      rows.push(el("span"), el("button", { onclick: fit }, "make it visible"), el("span"));
    }
    for (const ghost of player.ghosts) check(`ghost: ${ghost.name}`, true, (on) => player.showGhost(ghost, on));
    if (this.source.acts.loop) this.shown.loop = check(hint("loop"), this.source.loop, () => this.source.acts.loop());
    if (player.view) this.shown.quality = choice("quality", "quality of the picture", QUALITIES, (quality) => player.setLook({ quality }), player.quality);
    choice("theme", "colours of the page", ["auto", "light", "dark"], (name) => player.theme(name), player.themeName);
    const copyResult = el("span");
    const copy = async () => {
      player.remember();
      try {
        await navigator.clipboard.writeText(location.href);
        copyResult.textContent = "copied";
      } catch {
        copyResult.textContent = "it stands in the address bar";
      }
    };
    if (player.remember && /^(https?|file):$/.test(location.protocol)) {
      rows.push(el("span", {}, "link to this time"), el("button", { onclick: copy }, "copy"), copyResult);
    }
    this.panel.replaceChildren(...rows, this.notes);
  }
}
