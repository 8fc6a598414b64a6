// The table of the keys of all pages (viewer/keys.json): actions of keys, and their texts in help and on buttons.
import rows from "../../../keys.json" with { type: "json" };

/**
 * An action: its name, and its keys as `KeyboardEvent.key` in small letters, or for driving as `KeyboardEvent.code`, which
 * is a position on any keyboard.
 * @typedef {{act: string, keys?: string[], codes?: string[], shown: string, words: string, where?: string}} Row
 */

/** @type {Row[]} */
export const ROWS = rows;

/** Actions of driving by the code of their key, with the prefix `Shift+` if that is pressed too. */
export const DRIVING = Object.fromEntries(ROWS.flatMap(({ act, codes = [] }) => codes.map((code) => [code, act])));

/** A line of text on the keys for driving. */
export const DRIVING_WORDS = ROWS.filter(({ codes }) => codes)
  .map(({ shown, words }) => `${shown}: ${words}`)
  .join(", ");

/** Text of an action with its key, for a button. @param {string} act @returns {string} */
export function hint(act) {
  const { words, shown } = ROWS.find((row) => row.act === act);
  return `${words} (${shown})`;
}

/**
 * Name of the action of a key; undefined if the page has none.
 * @param {{key: string, code: string}} event
 * @param {Object<string, unknown>} acts actions of the page by name
 * @returns {string | undefined}
 */
export function actOf({ key, code }, acts) {
  const names = [key.toLowerCase(), code.replace(/^Digit/, "")]; // also digits that need Shift
  return ROWS.find(({ act, keys }) => act in acts && keys?.some((candidate) => names.includes(candidate.toLowerCase())))?.act;
}
