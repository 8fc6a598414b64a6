// Converts settings of the player to and from the address of the page, such as #t=1.25&camera=chase&plots=a

/** Settings of an address. @param {string} hash @returns {{time?: number, camera?: string, plots?: string[], speed?: number}} */
export function fromHash(hash) {
  const parameters = new URLSearchParams(hash.replace(/^#/, ""));
  const options = {};
  const number = (name) => (parameters.has(name) && parameters.get(name) !== "" ? Number(parameters.get(name)) : NaN);
  if (Number.isFinite(number("t"))) options.time = number("t");
  if (parameters.get("camera")) options.camera = parameters.get("camera");
  if (parameters.has("plots")) options.plots = parameters.getAll("plots").filter(Boolean);
  if (number("speed") >= 0.05 && number("speed") <= 10) options.speed = number("speed");
  return options;
}

/** Address of settings. @param {{time: number, camera?: string, plots: string[], speed: number}} state @returns {string} */
export function toHash({ time, camera, plots, speed }) {
  const parameters = new URLSearchParams({ t: String(Number(time.toPrecision(9))) });
  if (camera) parameters.set("camera", camera);
  if (speed !== 1) parameters.set("speed", String(speed));
  for (const name of plots) parameters.append("plots", name);
  return `#${parameters}`;
}
