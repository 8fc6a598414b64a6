// Settings of the player in the address of the page: #t=1.25&camera=chase&plots=a,b

/** @param {string} hash @returns {{time?: number, camera?: string, plots?: string[], speed?: number}} */
export function fromHash(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const made = {};
  const number = (name) => (given.has(name) && given.get(name) !== "" ? Number(given.get(name)) : NaN);
  if (Number.isFinite(number("t"))) made.time = number("t");
  if (given.get("camera")) made.camera = given.get("camera");
  if (given.has("plots")) made.plots = given.getAll("plots").filter(Boolean);
  if (number("speed") >= 0.05 && number("speed") <= 10) made.speed = number("speed");
  return made;
}

/** @param {{time: number, camera?: string, plots: string[], speed: number}} state @returns {string} */
export function toHash({ time, camera, plots, speed }) {
  const given = new URLSearchParams({ t: String(Number(time.toPrecision(9))) });
  if (camera) given.set("camera", camera);
  if (speed !== 1) given.set("speed", String(speed));
  for (const name of plots) given.append("plots", name);
  return `#${given}`;
}
