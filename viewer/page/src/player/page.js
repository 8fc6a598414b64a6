// A page of recordings as viewer/page_file.py writes it.
import { decoded } from "../sources/decode.js";
import { instead } from "../common/notices.js";
import { play } from "./play.js";

/**
 * Unpack the data of a page and play them.
 * @param {HTMLElement} container
 * @param {Data} page JSON
 * @returns {Data & {ready?: Promise<void>}} once that is resolved with the members of Player, or with `problem`
 */
export function playPage(container, page) {
  /** @type {Data} */
  const made = { problem: "" };
  made.ready = decoded(page)
    .then((given) => {
      made.player = play(container, given);
      made.set = (look) => made.player.setLook(look);
      for (const name of ["seek", "camera", "play", "pause", "toggle", "speed", "side"]) {
        made[name] = (...values) => made.player[name](...values);
      }
      for (const name of ["problem", "time", "view", "clock", "runs", "notes", "plots", "cameras"]) {
        Object.defineProperty(made, name, { get: () => made.player[name], configurable: true });
      }
      return made.player.ready;
    })
    .catch((error) => {
      made.problem = error.message;
      instead(container, "problem", `This page cannot be shown: ${error.message}`);
    });
  return made;
}
