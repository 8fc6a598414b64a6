// Which camera a key asks for: by its name, the wheels in turn, the next one.

/** Names by which the table of keys asks for cameras. */
const ASKED = ["driver", "chase", "wheel", "orbit", "top"];

/**
 * Acts of the keys that choose a camera.
 * @param {object} given
 * @param {() => string[]} given.names - That there are.
 * @param {() => string} given.now - That is chosen.
 * @param {(name: string) => void} given.choose - Told one of the names, or what was asked for where there is none of it.
 */
export function cameraActs({ names, now, choose }) {
  const following = (all) => all[(all.indexOf(now()) + 1) % all.length];
  const named = (asked) => {
    if (asked === "wheel") return following(names().filter((name) => name.startsWith("wheel"))) ?? asked;
    return asked === "top" && names().includes("map") ? "map" : asked;
  };
  const keyed = ASKED.map((asked) => [`camera ${asked}`, () => choose(named(asked))]);
  return { "next camera": () => names().length && choose(following(names())), ...Object.fromEntries(keyed) };
}
