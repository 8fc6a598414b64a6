// Parts that sources share: actions on the pace of a run, and units of columns.

const SLOW_SPEED = 0.25; // speed of the key L, simulated seconds per second
const REWIND_TIMES = [2, 10]; // s, without and with Shift

/**
 * Actions on the pace of a run, by their names in the table of keys.
 * @param {{speed: number}} source @param {{speed: (speed: number) => unknown, back: (seconds: number) => unknown}} functions
 */
export const speedActions = (source, { speed, back }) => ({
  speed,
  slow: () => speed(source.speed < 1 ? 1 : SLOW_SPEED),
  rewind: (/** @type {Data} */ event) => back(REWIND_TIMES[event?.shiftKey ? 1 : 0]),
});

/** Units by name, empty for dimensionless numbers. @param {string[]} names @param {(name: string) => string | undefined} unit */
export const unitsOf = (names, unit) => new Map(names.map((name) => [name, (unit(name) ?? "").replace(/^1$/, "")]));
