// Chooses the camera for a key: by its name, the wheels in turn, or the next one.

/** Names by which the table of keys asks for cameras. */
const ASKED = ["driver", "chase", "wheel", "orbit", "top"];

/**
 * Acts of the keys that choose a camera.
 * @param {object} given
 * @param {() => string[]} given.names - That there are.
 * @param {string[]} [given.all] - The same, where they are known already: keys of others then do nothing.
 * @param {() => string} given.now - That is chosen.
 * @param {(name: string) => void} given.choose - Told one of the names, or what was asked for where there is none of it.
 */
export function cameraActs({ names, all, now, choose }) {
  const following = (some) => some[(some.indexOf(now()) + 1) % some.length];
  const named = (asked) => {
    if (asked === "wheel") return following(names().filter((name) => name.startsWith("wheel"))) ?? asked;
    return asked === "top" && names().includes("map") ? "map" : asked;
  };
  const known = ASKED.filter((asked) => all?.some((name) => name.startsWith(asked)) ?? true);
  const keyed = known.map((asked) => [`camera ${asked}`, () => choose(named(asked))]);
  const next = all && all.length < 2 ? {} : { "next camera": () => choose(following(names())) };
  return { ...next, ...Object.fromEntries(keyed) };
}
