// What keys do in the simulator: driving first, then the run and the picture.
import { keys } from "../common/keys.js";
import { REWINDS } from "./controls.js";
import { KEYS as CAMERAS } from "./views.js";

/**
 * Listen to the keys of the page.
 * @param {import("../live/hands.js").Hands} hands @param {Data} act - See cockpit.js. @param {() => number} speed - m/s.
 * @param {AbortSignal} signal - Ends it.
 */
export function simulatorKeys(hands, act, speed, signal) {
  const acts = {
    p: act.toggle, ".": act.step, Home: act.reset, u: act.upright, l: act.slow, c: act.nextCamera, m: act.mute,
    f: act.arrows, b: act.stress, x: act.body, t: act.levers, g: act.panels, h: act.help, "/": act.help, "?": act.help,
    Backspace: ({ shiftKey }) => act.rewind(REWINDS[shiftKey ? 1 : 0]),
    ...Object.fromEntries(Object.entries(CAMERAS).map(([code, name]) => [code, () => act.camera(name)])),
  }; // prettier-ignore
  keys({ acts, signal, first: (event) => hands.key(event, speed()) });
}
