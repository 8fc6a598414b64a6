// Actions of keys that choose a camera: one by name, the wheels in turn, or the next one.

/** Names of cameras in the table of keys. */
const KEY_NAMES = ["driver", "chase", "wheel", "orbit", "top"];

/** @param {string[]} names of the cameras @param {() => string} now the current camera @param {(name: string) => void} choose */
export function cameraActs(names, now, choose) {
  const nextOf = (cycle) => cycle[(cycle.indexOf(now()) + 1) % cycle.length];
  const nameOf = (key) => (key === "wheel" ? nextOf(names.filter((name) => name.startsWith("wheel"))) : key === "top" && names.includes("map") ? "map" : key);
  const known = KEY_NAMES.filter((key) => names.some((name) => name.startsWith(key)) || names.includes(nameOf(key)));
  const keyed = known.map((key) => [`camera ${key}`, () => choose(nameOf(key))]);
  return { ...(names.length < 2 ? {} : { "next camera": () => choose(nextOf(names)) }), ...Object.fromEntries(keyed) };
}
