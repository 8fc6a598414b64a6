// Prepares signals for diagrams: resampling, grouping by unit, search.
import { linear, place } from "../sources/sampler.js";

/**
 * A signal at the times of another run; null outside its own times.
 * @param {ArrayLike<number>} t @param {ArrayLike<number>} data
 * @param {ArrayLike<number>} times
 * @returns {(number | null)[]}
 */
export function resampled(t, data, times) {
  const [first, last] = [t[0], t[t.length - 1]];
  return Array.from(times, (time) => {
    if (time < first || time > last) return null;
    const value = linear(data, ...place(t, time));
    return Number.isFinite(value) ? value : null;
  });
}

/** Values for a diagram, with null in place of NaN and infinity. @param {ArrayLike<number>} data */
export const values = (data) => Array.from(data, (value) => (Number.isFinite(value) ? value : null));

/**
 * Signals by unit, in the order of their names.
 * @param {string[]} names @param {Map<string, string>} columns units by name
 * @returns {Map<string, string[]>}
 */
export function byUnit(names, columns) {
  const groups = new Map();
  for (const name of names) {
    const unit = columns.get(name);
    if (unit === undefined) continue;
    groups.set(unit, [...(groups.get(unit) ?? []), name]);
  }
  return groups;
}

/** Names that contain all words of a search, in any order. @param {string[]} names @param {string} search */
export function found(names, search) {
  const words = search.toLowerCase().split(/\s+/).filter(Boolean);
  return names.filter((name) => words.every((word) => name.toLowerCase().includes(word)));
}
