// Dispatches keys of a page: first to the focused element, then to driving, then to actions by name.
import { actOf } from "./key_table.js";

/** Whether the focus came by the keyboard: a box that was clicked leaves the keys to the page. */
let tabbed = false;

/**
 * Whether an element needs a key itself.
 * @param {Partial<HTMLInputElement>} target
 * @param {string} key - As in `KeyboardEvent.key`.
 * @param {boolean} byKeyboard - Whether the keyboard has brought the focus there.
 */
export function needed({ tagName, type, isContentEditable }, key, byKeyboard) {
  if (tagName === "SELECT" || tagName === "TEXTAREA" || isContentEditable) return true;
  if (tagName === "INPUT" && /^(number|text|search)$/.test(type)) return true;
  if (!byKeyboard) return false;
  if (tagName === "INPUT" && type === "range") return /^(Arrow|Page|Home|End)/.test(key);
  return /^(INPUT|BUTTON|SUMMARY|A)$/.test(tagName) && /^( |Enter)$/.test(key);
}

/**
 * Listen to the keys of a page until a signal ends it.
 * @param {object} options
 * @param {Object<string, (event: KeyboardEvent) => void>} options.acts - By their names in the table of keys.
 * @param {(event: KeyboardEvent) => boolean} [options.first] - Takes what drives, down and up, whatever has the focus
 *   when a key goes up; says whether it did.
 * @param {AbortSignal} options.signal
 */
export function keys({ acts, first = () => false, signal }) {
  const focused = ({ target }) => (tabbed = target.matches?.(":focus-visible") ?? false);
  const listener = (/** @type {KeyboardEvent} */ event) => {
    const down = event.type === "keydown";
    const { key, code, ctrlKey, altKey, metaKey, repeat } = event;
    const own = needed(/** @type {HTMLElement} */ (event.target), key, tabbed);
    if (down && (own || ctrlKey || altKey || metaKey)) return; // a key that was down is let go in any case
    const driven = first(event);
    const act = acts[actOf(event, acts)];
    if (own || !(driven || act)) return;
    event.preventDefault();
    if (down && !driven && (!repeat || code.startsWith("Arrow"))) act(event);
  };
  const options = { capture: true, signal };
  window.addEventListener("focusin", focused, options);
  window.addEventListener("keydown", listener, options);
  window.addEventListener("keyup", listener, options);
}
