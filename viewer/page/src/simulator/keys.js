// What keys do in the simulator: driving first, then the run and the picture.
import { typing } from "../live/hands.js";
import { REWINDS } from "./controls.js";
import { KEYS as CAMERAS } from "./views.js";

/** The keys of the page. */
export class Keys {
  /** @param {import("../live/hands.js").Hands} hands @param {Data} act - See cockpit.js. @param {() => number} speed - m/s. */
  constructor(hands, act, speed) {
    this._hands = hands;
    this._speed = speed;
    this._acts = {
      KeyP: act.toggle, Period: act.step, Home: act.reset, KeyU: act.upright, KeyL: act.slow, KeyC: act.nextCamera, KeyM: act.mute,
      KeyF: act.arrows, KeyB: act.stress, KeyT: act.levers, KeyG: act.panels, KeyH: act.help, Slash: act.help,
      Backspace: (event) => act.rewind(REWINDS[event.shiftKey ? 1 : 0]),
      ...Object.fromEntries(Object.entries(CAMERAS).map(([code, name]) => [code, () => act.camera(name)])),
    }; // prettier-ignore
  }

  /** @param {KeyboardEvent} event */
  take(event) {
    const down = event.type === "keydown";
    const other = typing(/** @type {HTMLElement} */ (event.target)) || event.ctrlKey || event.metaKey || event.altKey;
    if (down && other) return; // a key that was down is let go in any case
    if (this._hands.key(event, this._speed())) {
      event.preventDefault();
      return;
    }
    const work = this._acts[event.code];
    if (!work) return;
    event.preventDefault();
    if (down && !event.repeat) work(event);
  }
}
