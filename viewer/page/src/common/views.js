// Actions of keys that choose a camera: one by name, the wheels in turn, or the next one.

/** Names of cameras in the table of keys. */
const KEY_NAMES = ["driver", "chase", "wheel", "orbit", "top"];

/**
 * Actions of the keys that choose a camera.
 * @param {object} options
 * @param {() => string[]} options.names - Names of the cameras.
 * @param {string[]} [options.all] - The same, if they are known already: other keys then have no action.
 * @param {() => string} options.now - The current camera.
 * @param {(name: string) => void} options.choose - Receives a name of a camera, or that of the key if there is none.
 */
export function cameraActs({ names, all, now, choose }) {
  const nextOf = (cycle) => cycle[(cycle.indexOf(now()) + 1) % cycle.length];
  const nameOf = (keyName) => {
    if (keyName === "wheel") return nextOf(names().filter((name) => name.startsWith("wheel"))) ?? keyName;
    return keyName === "top" && names().includes("map") ? "map" : keyName;
  };
  const known = KEY_NAMES.filter((keyName) => all?.some((name) => name.startsWith(keyName)) ?? true);
  const keyed = known.map((keyName) => [`camera ${keyName}`, () => choose(nameOf(keyName))]);
  const next = all && all.length < 2 ? {} : { "next camera": () => choose(nextOf(names())) };
  return { ...next, ...Object.fromEntries(keyed) };
}
