// Dispatches key events of a page: to the focused element or part, else to driving, else to an action; keeps the focus.
import { actOf } from "./key_table.js";

/** Whether the focus was moved by the keyboard; a clicked check box does not take keys. */
let focusedByKeyboard = false;

/** Actions of parts that have keys of their own, by these keys. @type {WeakMap<EventTarget, Object<string, (event: KeyboardEvent) => unknown>>} */
const actsOfParts = new WeakMap();

/** Actions of the list of keys. */
const DIALOG_ACTS = ["help", "close"];

/**
 * Whether an element needs a key itself.
 * @param {Partial<HTMLInputElement>} target
 * @param {string} key as in `KeyboardEvent.key`
 * @param {boolean} byKeyboard whether the keyboard has moved the focus to it
 */
export function needed({ tagName, type, value, isContentEditable }, key, byKeyboard) {
  if (key === "Escape") return type === "search" && Boolean(value); // which it empties
  if (tagName === "SELECT" || tagName === "TEXTAREA" || isContentEditable) return true;
  if (tagName === "INPUT" && /^(number|text|search)$/.test(type)) return true;
  if (!byKeyboard) return false;
  if (tagName === "DIALOG" || (tagName === "INPUT" && type === "range")) return /^(Arrow|Page|Home|End)/.test(key);
  return /^(INPUT|BUTTON|SUMMARY|A)$/.test(tagName) && /^( |Enter)$/.test(key);
}

/** Whether a part of the page has the focus, moved there by the keyboard. @param {HTMLElement} part */
export function hasKeyboardFocus(part) {
  return focusedByKeyboard && part.contains(document.activeElement);
}

/**
 * Gives a part of the page keys of its own, which act while the keyboard has moved the focus to it.
 * @param {HTMLElement} part
 * @param {string} label its name for screen readers
 * @param {Object<string, (event: KeyboardEvent) => unknown>} acts by `KeyboardEvent.key`; false: the key is left to the page
 */
export function addKeys(part, label, acts) {
  part.tabIndex = 0;
  part.setAttribute("role", "application"); // otherwise screen readers keep the arrows to themselves
  part.setAttribute("aria-label", label);
  part.addEventListener("click", () => focusedByKeyboard || part.blur()); // clicked, it leaves the keys to the page
  actsOfParts.set(part, acts);
}

/**
 * Shows or hides a part of the page; a focus that the keyboard has moved into a hidden part goes to the button that opens it.
 * @param {HTMLElement} part
 * @param {boolean} open
 * @param {HTMLElement} [opener]
 */
export function show(part, open, opener) {
  if (!open && hasKeyboardFocus(part)) opener?.focus();
  part.hidden = !open;
  opener?.setAttribute("aria-pressed", String(open));
}

/**
 * Handles the keys of a page until a signal ends it.
 * @param {object} options
 * @param {Object<string, (event: KeyboardEvent) => void>} options.acts actions by their names in the table of keys
 * @param {(event: KeyboardEvent) => boolean} [options.first] handles key events of driving, those of release with
 *   any focus; returns whether it did.
 * @param {HTMLDialogElement} [options.dialog] the list of keys; while it is open only its own actions are done
 * @param {AbortSignal} options.signal
 */
export function keys({ acts, first = () => false, dialog, signal }) {
  const noteFocus = ({ target }) => (focusedByKeyboard = target.matches?.(":focus-visible") ?? false);
  const listener = (/** @type {KeyboardEvent} */ event) => {
    const down = event.type === "keydown";
    const { key, code, ctrlKey, altKey, metaKey, repeat } = event;
    const isNeeded = needed(/** @type {HTMLElement} */ (event.target), key, focusedByKeyboard);
    const name = actOf(event, acts);
    const isBehind = dialog?.open && !DIALOG_ACTS.includes(name);
    if (down && (isNeeded || isBehind || ctrlKey || altKey || metaKey)) return; // releases are handled in any case
    const ofPart = down && focusedByKeyboard ? actsOfParts.get(event.target)?.[key] : undefined;
    if (ofPart && ofPart(event) !== false) {
      event.preventDefault();
      return;
    }
    const driven = first(event);
    const act = acts[name];
    if (isNeeded || isBehind || !(driven || act)) return;
    event.preventDefault();
    if (down && !driven && (!repeat || code.startsWith("Arrow"))) act(event);
  };
  const options = { capture: true, signal };
  window.addEventListener("focusin", noteFocus, options);
  window.addEventListener("keydown", listener, options);
  window.addEventListener("keyup", listener, options);
}
