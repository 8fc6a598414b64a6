// Computes force vectors at earth positions from columns, and rounds numbers for legends.
import { cross, finite, rotate, scale, subtract, unit } from "./math.js";

/**
 * Forces of an arrow.
 * @param {Data} arrow an entry of `arrows` of a scene
 * @param {import("./frames.js").Frames} frames
 * @param {(name: string) => number | undefined} lookup
 * @returns {{at: number[], vector: number[]}[] | string} forces, or a sentence on why there are none
 */
export function forcesOf(arrow, frames, lookup) {
  if (arrow.between !== undefined) return between(arrow, frames, lookup);
  if (arrow.tyre !== undefined) return tyre(arrow, lookup);
  return vector(arrow, frames, lookup);
}

const numbers = (names, lookup) => names.map((name) => lookup(name));
const missingText = (arrow, names, lookup) =>
  `The arrow '${arrow.name}' is not drawn where the column '${names.find((name) => !Number.isFinite(lookup(name)))}' has no number.`;

/** Forces along a line; a positive value times `sign` pushes the two bodies apart. */
function between(arrow, frames, lookup) {
  const value = lookup(arrow.value);
  if (!Number.isFinite(value)) return missingText(arrow, [arrow.value], lookup);
  const [from, to] = arrow.between.map(([frame, local]) => frames.point(frame, local));
  if (from === null || to === null) return `The arrow '${arrow.name}' is not drawn where its bodies have no pose.`;
  const along = unit(subtract(to, from));
  if (along === null) return [];
  const force = scale(along, (arrow.sign ?? 1) * value);
  return [{ at: to, vector: force }, { at: from, vector: scale(force, -1) }]; // prettier-ignore
}

/** Force with three components. */
function vector(arrow, frames, lookup) {
  const parts = numbers(arrow.vector, lookup);
  if (!finite(parts)) return missingText(arrow, arrow.vector, lookup);
  const [frame, local] = arrow.at;
  const at = frames.point(frame, local);
  const axes = frames.pose(arrow.axes ?? "ground");
  if (at === null || !axes.shown) return `The arrow '${arrow.name}' is not drawn where its bodies have no pose.`;
  return [{ at, vector: rotate(axes.rotation, parts) }];
}

/** Force on a wheel at its contact, with x = axis x normal, y = normal x x, z = normal. */
function tyre(arrow, lookup) {
  const { contact, normal, axis, forces } = arrow.tyre;
  const names = [...contact, ...normal, ...axis, ...forces];
  if (!finite(numbers(names, lookup))) return missingText(arrow, names, lookup);
  const z = unit(numbers(normal, lookup));
  const x = z && unit(cross(numbers(axis, lookup), z));
  if (!x) return [];
  const y = cross(z, x);
  const [fx, fy, fz] = numbers(forces, lookup);
  return [{ at: numbers(contact, lookup), vector: [0, 1, 2].map((i) => fx * x[i] + fy * y[i] + fz * z[i]) }];
}

/** Value rounded up to 1, 2, 5, 10, ... @param {number} value */
export function niceAbove(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((n) => n * power).find((n) => n >= value * (1 - 1e-9));
}

/** Length rounded down to 1, 2, 5, 10, ... @param {number} length */
export function niceStep(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].map((n) => n * power).find((step) => step <= length * 1.0000001) ?? power;
}

/** @type {[number, string][]} */
const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "u"]]; // prettier-ignore

/** Text of a number with its unit, such as "250 MPa" for 2.5e8 Pa. @param {number} value @param {string} unitName @param {number} [like] see `parted` */
export const worded = (value, unitName, like) => parted(value, unitName, like).join(" ");

/**
 * Number and prefixed unit of a value.
 * @param {number} value @param {string} unitName
 * @param {number} [like] value whose prefix is used, unless `value` is below a thousandth of it
 * @returns {[number, string]}
 */
export function parted(value, unitName, like = value) {
  const reference = Math.abs(value) < Math.abs(like) / 1000 ? value : like;
  const fits = (/** @type {[number, string]} */ [factor]) => Number(Math.abs(reference).toPrecision(3)) >= factor;
  const [size, prefix] = value === 0 ? [1, ""] : (PREFIXES.find(fits) ?? PREFIXES[PREFIXES.length - 1]);
  return [Number((value / size).toPrecision(3)), `${prefix}${unitName.replaceAll(".", "\u00b7")}`];
}
