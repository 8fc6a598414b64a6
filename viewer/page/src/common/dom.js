// Makes HTML and SVG elements, and formats numbers.

/**
 * Makes an element.
 * @template {string} Tag
 * @param {Tag} tag name, with classes after dots
 * @param {Data} [properties] properties, listeners as `onclick`; names with a hyphen and `role` become attributes, and `data`
 *   the attribute data-a3, which identifies it to programs.
 * @param {...(Node | string | number)} children
 * @returns {ElementOf<Tag>}
 */
export function el(tag, properties = {}, ...children) {
  const [name, ...classes] = tag.split(".");
  const element = /** @type {ElementOf<Tag>} */ (document.createElement(name));
  if (classes.length) element.className = classes.join(" ");
  for (const [key, value] of Object.entries(properties)) {
    if (key === "data") element.setAttribute("data-a3", value);
    else if (key === "role" || key.includes("-")) element.setAttribute(key, value);
    else element[key] = value;
  }
  if (/^(input|select)$/.test(name) && element.title && !element.hasAttribute("aria-label")) element.setAttribute("aria-label", element.title);
  element.append(.../** @type {(Node | string)[]} */ (children));
  return element;
}

/**
 * A button that releases the focus after a click, so that keys still drive the car.
 * @param {string} data see `el`
 * @param {string} text
 * @param {() => void} action
 * @param {string} [title]
 */
export function button(data, text, action, title = "") {
  const onclick = () => {
    if (!element.matches(":focus-visible")) element.blur();
    action();
  };
  const element = el("button", { type: "button", title, data, onclick }, text);
  return element;
}

/**
 * A drop-down list that releases the focus, unless keys were used.
 * @param {string} data
 * @param {string} title
 * @param {(string | number)[][]} options values and their labels
 * @param {(value: string) => void} action
 * @param {string | number} [value] initial choice
 */
export function select(data, title, options, action, value) {
  const element = el("select", { title, data }, ...options.map(([v, words]) => el("option", { value: v }, words)));
  if (value !== undefined) element.value = String(value);
  element.addEventListener("change", () => {
    action(element.value);
    if (!element.matches(":focus-visible")) element.blur();
  });
  // In a closed list these keys would choose each option that they pass; on macOS they open it too.
  element.addEventListener("keydown", (event) => {
    if (!/^(Arrow|Page|Home|End)/.test(event.key) || !element.showPicker) return;
    try {
      element.showPicker();
    } catch {
      return; // the frame of a notebook refuses it; there the keys choose
    }
    event.preventDefault();
  });
  return element;
}

/** Options of `select` whose labels are their values. @param {string[]} names */
export function named(names) {
  return names.map((name) => [name, name]);
}

/** Sets the text of an element, if it differs. @param {Element} element @param {string} text */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Makes an element of SVG. @param {string} tag @param {Object<string, string | number>} [properties] @param {...Node} children */
export function svg(tag, properties = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(properties)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

const ICONS = {
  play: "M3 1l10 6-10 6z",
  pause: "M2 1h4v12H2zM8 1h4v12H8z",
  back: "M1 1h2.5v12H1zM13 1v12L4.5 7z",
  forward: "M10.5 1H13v12h-2.5zM1 1l8.5 6L1 13z",
  reset: "M1 1h2v12H1zM8.5 1v12L3.5 7zM14 1v12L9 7z",
  rewind: "M7.5 1v12L1 7zM14 1v12L7.5 7z",
  sound: "M1 5h3l4-4v12L4 9H1zM9.5 4.5q3 2.5 0 5zM10 1.5q6 5.500 0 11l-.6-1q4.500-4.500 0-9z",
  silent: "M1 5h3l4-4v12L4 9H1zM9.500 4.500l4.500 4.500-1 1-4.500-4.500zM13 4.500l1 1-4.500 4.500-1-1z",
  full: "M1 1h5v2H3v3H1zM8 1h5v5h-2V3H8zM1 8h2v3h3v2H1zM11 8h2v5H8v-2h3z",
};

/** Makes an icon. @param {keyof typeof ICONS} name */
export function icon(name) {
  return svg("svg", { viewBox: "0 0 14 14", "aria-hidden": "true" }, svg("path", { d: ICONS[name] }));
}

/** Text of a number rounded to an integer, never -0. @param {number} value */
export const whole = (value) => (Number.isFinite(value) ? String(Math.round(value)) : "–");

/** Text of a number with a count of decimals, never -0. @param {number} value @param {number} decimals */
export const fixed = (value, decimals) => (Number(value.toFixed(decimals)) + 0).toFixed(decimals);

/** Text of a number with four digits. */
export function short(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}
