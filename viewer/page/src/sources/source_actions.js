// What sources have in common: acts on the pace of a run, units of what can be plotted.

const SLOW = 0.25; // what L makes of the speed
const REWINDS = [2, 10]; // s, without and with Shift

/**
 * Acts on the pace of a run, by the names of the table of keys.
 * @param {{speed: number}} source @param {{speed: (speed: number) => unknown, back: (seconds: number) => unknown}} means
 */
export const speedActions = (source, { speed, back }) => ({
  speed,
  slow: () => speed(source.speed < 1 ? 1 : SLOW),
  rewind: (/** @type {Data} */ event) => back(REWINDS[event?.shiftKey ? 1 : 0]),
});

/** Units by name, that of a pure number empty. @param {string[]} names @param {(name: string) => string | undefined} unit */
export const unitsOf = (names, unit) => new Map(names.map((name) => [name, (unit(name) ?? "").replace(/^1$/, "")]));
