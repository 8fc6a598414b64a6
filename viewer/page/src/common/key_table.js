// The one table of the keys of all pages, viewer/keys.json: what a key does, its help, its words on a button.
import rows from "../../../keys.json" with { type: "json" };

/**
 * What a person can do with a key: its name, its keys as in `KeyboardEvent.key` in small letters, or, of what drives,
 * as in `KeyboardEvent.code`, so that they lie at one place on every keyboard.
 * @typedef {{act: string, keys?: string[], codes?: string[], shown: string, words: string, where?: string}} Row
 */

/** @type {Row[]} */
export const ROWS = rows;

/** Keys that drive, by their codes, with `Shift+` where that is held. */
export const DRIVING = Object.fromEntries(ROWS.flatMap(({ act, codes = [] }) => codes.map((code) => [code, act])));

/** One line of the keys that drive. */
export const DRIVING_WORDS = ROWS.filter(({ codes }) => codes)
  .map(({ shown, words }) => `${shown}: ${words}`)
  .join(", ");

/** @param {string} act @returns {string} its words with its key, for a button */
export function hint(act) {
  const { words, shown } = ROWS.find((row) => row.act === act);
  return `${words} (${shown})`;
}

/**
 * What a key does in a page.
 * @param {{key: string, code: string}} event
 * @param {Object<string, unknown>} acts what the page can do, by their names
 * @returns {string | undefined}
 */
export function actOf({ key, code }, acts) {
  const names = [key.toLowerCase(), code.replace(/^Digit/, "")]; // digits also where they need Shift
  return ROWS.find(({ act, keys }) => act in acts && keys?.some((one) => names.includes(one.toLowerCase())))?.act;
}
