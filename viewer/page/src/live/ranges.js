// Ranges of sliders: those of the variables, or marked guesses.

/** Guessed half-widths around 0 by unit, for variables that start at 0. */
const GUESSES = { m: 10, "m/s": 40, "m/s2": 10, rad: Math.PI, "rad/s": 10, N: 1000, "N.m": 100, kg: 100, s: 10, "1": 1 };
/** Least ratio of the ends of a range of a logarithmic slider. */
const LOGARITHMIC_RATIO = 50;

/** Share of a guess below which a start value counts as 0. */
const ZERO_SHARE = 1e-3;

/**
 * The range of a variable.
 * @param {{min?: number, max?: number, start?: number, unit?: string, type: string, largest?: number}} variable with
 *   the largest known absolute value, if any.
 * @returns {{low: number, high: number, guessed: boolean, log: boolean, whole: boolean}}
 */
export function rangeOf({ min, max, start, unit, type, largest = 0 }) {
  const whole = type === "Integer" || type === "Enumeration";
  const guess = whole ? 10 : (GUESSES[unit ?? "1"] ?? 10);
  const begin = Math.max(Math.abs(Number(start ?? 0)), largest);
  const width = begin < ZERO_SHARE * guess && !largest ? guess : rounded(2 * begin);
  let low = min ?? Math.min(-width, max === undefined ? 0 : max - 2 * width);
  let high = max ?? Math.max(width, min === undefined ? 0 : min + 2 * width);
  if (whole) [low, high] = [Math.ceil(low), Math.floor(high)];
  const guessed = min === undefined || max === undefined;
  return { low, high, guessed, log: !whole && low > 0 && high / low >= LOGARITHMIC_RATIO, whole };
}

/** The value rounded up to one digit. */
function rounded(value) {
  const unit = 10 ** Math.floor(Math.log10(value));
  return Number((Math.ceil(value / unit - 1e-9) * unit).toPrecision(3));
}

/** Position of a value on a slider, 0 to 1. */
export function toSlider(range, value) {
  const { low, high, log } = range;
  const x = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low || 1);
  return Math.max(0, Math.min(1, x));
}

/** Value at a position on a slider, 0 to 1; exactly the limits at its ends. */
export function fromSlider(range, x) {
  const { low, high, log, whole } = range;
  if (x <= 0) return low;
  if (x >= 1) return high;
  const value = log ? low * (high / low) ** x : low + x * (high - low);
  if (whole) return Math.round(value) || 0;
  const digits = 10 ** (Math.floor(Math.log10(log ? value : high - low)) - 3);
  return Math.max(low, Math.min(high, Number((Math.round(value / digits) * digits).toPrecision(12))));
}

/**
 * Choices of an integer variable with few values, with labels from its description, such as "0 neutral"; null for others.
 * @param {Data} variable
 * @returns {[number, string][] | null}
 */
export function choicesOf({ type, min, max, description = "", items }) {
  if (items && Object.keys(items).length) return Object.entries(items).map(([name, value]) => [value, `${value} ${name}`]);
  if (type !== "Integer" || min === undefined || max === undefined || max - min > 12) return null;
  const words = new Map();
  for (const [, number, word] of description.matchAll(/(-?\d+) ([a-z_]+)/g)) words.set(Number(number), word);
  return Array.from({ length: max - min + 1 }, (_, i) => {
    const value = min + i;
    return [value, words.has(value) ? `${value} ${words.get(value)}` : String(value)];
  });
}
