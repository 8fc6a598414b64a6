// Elements of the page.

/**
 * An element.
 * @template {string} Tag
 * @param {Tag} tag - Name, with classes after dots.
 * @param {Data} [set] - Properties; `data` becomes the attribute data-a3, by which programs find it.
 * @param {...(Node | string | number)} children
 * @returns {ElementOf<Tag>}
 */
export function el(tag, set = {}, ...children) {
  const [name, ...classes] = tag.split(".");
  const element = /** @type {ElementOf<Tag>} */ (document.createElement(name));
  if (classes.length) element.className = classes.join(" ");
  const { data, ...properties } = set;
  if (data) element.setAttribute("data-a3", data);
  Object.assign(element, properties);
  element.append(.../** @type {(Node | string)[]} */ (children));
  return element;
}

/**
 * A button that gives the focus back, so that the keys go on driving.
 * @param {string} data - See `el`.
 * @param {string} text
 * @param {string} title
 * @param {() => void} work
 */
export function button(data, text, title, work) {
  const made = el("button", { type: "button", title, data }, text);
  made.addEventListener("click", () => {
    work();
    made.blur();
  });
  return made;
}

/**
 * A choice that gives the focus back.
 * @param {string} data
 * @param {string} title
 * @param {(string | number)[][]} options - Values and their words.
 * @param {(value: string) => void} work
 * @param {string | number} [value] - Chosen at first.
 */
export function select(data, title, options, work, value) {
  const made = el("select", { title, data }, ...options.map(([v, words]) => el("option", { value: v }, words)));
  if (value !== undefined) made.value = String(value);
  made.addEventListener("change", () => {
    work(made.value);
    made.blur();
  });
  return made;
}

/** Write a text, where it is another one. @param {HTMLElement} element @param {string} text */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** An element of a drawing. @param {string} tag @param {Object<string, string | number>} [set] @param {...Node} children */
export function svg(tag, set = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(set)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** A number for a person: four digits. */
export function short(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}
