// Elements of the page.

/**
 * An element.
 * @param {string} tag - Name, with classes after dots.
 * @param {object} [set] - Properties; `data` becomes the attribute data-a3, by which programs find it.
 * @param {...(Node|string)} children
 * @returns {HTMLElement}
 */
export function el(tag, set = {}, ...children) {
  const [name, ...classes] = tag.split(".");
  const element = document.createElement(name);
  if (classes.length) element.className = classes.join(" ");
  const { data, ...properties } = set;
  if (data) element.setAttribute("data-a3", data);
  Object.assign(element, properties);
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
