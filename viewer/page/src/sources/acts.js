// What sources have in common: acts on the pace of a run, units of what can be plotted.

/** What L makes of the speed. */
const SLOW = 0.25;
/** Seconds of a rewind, without and with Shift. */
const REWINDS = [2, 10];

/**
 * Acts on the pace of a run, by the names of the table of keys.
 * @param {{speed: number}} source
 * @param {{speed: (wish: number) => unknown, back: (seconds: number) => unknown}} means
 */
export function paceActs(source, { speed, back }) {
  return {
    speed,
    slow: () => speed(source.speed < 1 ? 1 : SLOW),
    rewind: (/** @type {Data} */ event) => back(event?.shiftKey ? REWINDS[1] : REWINDS[0]),
  };
}

/**
 * Names and units of what can be plotted; what has no unit has an empty one.
 * @param {string[]} names @param {(name: string) => string | undefined} unit
 * @returns {Map<string, string>}
 */
export function unitsOf(names, unit) {
  return new Map(names.map((name) => [name, unit(name) ?? ""]).map(([name, found]) => [name, found === "1" ? "" : found]));
}
