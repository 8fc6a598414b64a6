// Vectors [x, y, z] and rotations as nine numbers, row by row, in double precision.
import { Matrix3, Matrix4, Quaternion } from "three";

/** @typedef {number[]} Vector three numbers */
/** @typedef {number[]} Rotation nine numbers, row by row; transforms coordinates of a frame to those of its parent */

export const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const middle = (a, b) => scale(add(a, b), 0.5);
export const finite = (a) => a.every(Number.isFinite);
/** Remainder of a real number, from 0 to below `period`. */
export const modulo = (a, period) => a - period * Math.floor(a / period);

/** @param {Vector} a @param {Vector} b @returns {Vector} */
export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** Unit vector along `a`; null if `a` has no direction. @param {Vector} a @returns {Vector | null} */
export function unit(a) {
  const size = length(a);
  return size > 0 && Number.isFinite(size) ? scale(a, 1 / size) : null;
}

/** A unit vector perpendicular to a unit vector. @param {Vector} a @returns {Vector} */
export function across(a) {
  const [x, y, z] = a.map(Math.abs);
  return unit(cross(a, x <= y && x <= z ? [1, 0, 0] : y <= z ? [0, 1, 0] : [0, 0, 1]));
}

/** Unit vector of the part of `a` that is perpendicular to a unit vector; null if there is none. @param {Vector} a @param {Vector} axis @returns {Vector | null} */
export const perpendicular = (a, axis) => unit(subtract(a, scale(axis, dot(a, axis))));

/** Unit vector perpendicular to a unit vector, towards x where that is not nearly along it. @param {Vector} axis @returns {Vector} */
export const sideways = (axis) => (Math.abs(axis[0]) < 0.9 ? perpendicular([1, 0, 0], axis) : across(axis));

/** R v. @param {Rotation} R @param {Vector} v @returns {Vector} */
export function rotate(R, v) {
  return [
    R[0] * v[0] + R[1] * v[1] + R[2] * v[2],
    R[3] * v[0] + R[4] * v[1] + R[5] * v[2],
    R[6] * v[0] + R[7] * v[1] + R[8] * v[2],
  ];
}

/** A B; three.js stores matrices column by column. @param {Rotation} A @param {Rotation} B @returns {Rotation} */
export const product = (A, B) => new Matrix3().fromArray(B).multiply(new Matrix3().fromArray(A)).toArray();

/** @param {Rotation} R @returns {Rotation} */
export const transpose = (R) => [R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]];

/** Rotation whose columns are three vectors. @returns {Rotation} */
export const fromColumns = (x, y, z) => [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]];

/** Rotation of a quaternion (w, x, y, z) of any length; null for one of length zero. @param {number[]} quaternion @returns {Rotation | null} */
export function fromQuaternion([w, x, y, z]) {
  const n = w * w + x * x + y * y + z * z;
  if (!(n > 0) || !Number.isFinite(n)) return null;
  const s = 2 / n;
  return [
    1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
    s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
    s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y),
  ]; // prettier-ignore
}

/** Quaternion (w, x, y, z) of a rotation, with w >= 0 or the largest component positive. @param {Rotation} R */
export function toQuaternion(R) {
  const { x, y, z, w } = new Quaternion().setFromRotationMatrix(new Matrix4().setFromMatrix3(new Matrix3().fromArray(transpose(R))));
  return [w, x, y, z];
}

/** Right-handed rotation by an angle about an axis; null for an axis without direction. @returns {Rotation | null} */
export function aboutAxis(axis, angle) {
  const u = unit(axis);
  if (u === null || !Number.isFinite(angle)) return null;
  const h = Math.sin(angle / 2);
  return fromQuaternion([Math.cos(angle / 2), u[0] * h, u[1] * h, u[2] * h]);
}

/** Axes of three points: x from the first to the second, the third in the x-y plane; null if they are on a line. */
export function axesOfPoints(a, b, c) {
  const x = unit(subtract(b, a));
  if (x === null) return null;
  const to = subtract(c, a);
  const aside = subtract(to, scale(x, dot(x, to)));
  if (!(length(aside) > 1e-9 * length(to))) return null;
  const y = unit(aside);
  return fromColumns(x, y, cross(x, y));
}
