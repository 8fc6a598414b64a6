// Interpolates numbers between two instants: linearly, angles by the shorter turn and quaternions by the shorter arc.
import { Quaternion } from "three";

/**
 * The change of an angle from one row to the next, rad. An angle between -pi and pi may jump from one end to the other;
 * one outside of them counts turns and does not jump.
 */
function angleChange(a, b) {
  const change = b - a;
  const wrapped = Math.abs(change) > Math.PI && Math.max(Math.abs(a), Math.abs(b)) < Math.PI + 1e-6;
  return wrapped ? change - 2 * Math.PI * Math.sign(change) : change;
}

/**
 * Interpolates between two orientations along the shorter arc; q and -q are the same orientation.
 * @param {number[]} a @param {number[]} b quaternions (w, x, y, z) of any norm but zero
 * @param {number} share of the way from a to b
 * @returns {number[]} unit quaternion
 */
export function slerp(a, b, share) {
  const [from, to] = [a, b].map((parts) => {
    const [w, x, y, z] = parts.map((part) => part / Math.hypot(...parts)); // three.js would treat a quaternion of zeros as the identity
    return new Quaternion(x, y, z, w);
  });
  const { x, y, z, w } = from.slerp(to, share);
  return [w, x, y, z];
}

/** Interpolates the columns of two rows. */
export class Blend {
  /** By the name of a quaternion's part: the names of all four, and its index. @type {Map<string, [string[], number]>} */
  _parts = new Map();

  /**
   * @param {Data | null | undefined} scene its frames say which columns are angles and quaternions
   * @param {Iterable<{name: string, unit?: string, type?: string}>} [variables] those in rad are angles too; those of the type
   *   Integer are taken from the nearer row.
   */
  constructor(scene, variables = []) {
    const [frames, listed] = [Object.values(scene?.frames ?? {}), [...variables]];
    this._angles = new Set([...frames.map(({ angle }) => angle), ...listed.filter(({ unit }) => unit === "rad").map(({ name }) => name)]);
    this._whole = new Set(listed.filter(({ type }) => type === "Integer").map(({ name }) => name));
    for (const { quaternion = [] } of frames) quaternion.forEach((name, part) => this._parts.set(name, [quaternion, part]));
  }

  /**
   * A lookup of interpolated numbers.
   * @param {(name: string) => number | undefined} a lookup of the row before @param {(name: string) => number | undefined} b of the row after
   * @param {number} s share of the way from a to b, from 0 to 1
   * @returns {(name: string) => number | undefined}
   */
  lookup(a, b, s) {
    if (s === 0 || s === 1) return s === 0 ? a : b;
    const turns = new Map();
    return (name) => {
      const [from, to] = [a(name), b(name)];
      if (from === undefined || to === undefined) return undefined;
      if (this._whole.has(name)) return s < 0.5 ? from : to;
      if (this._angles.has(name)) return from + s * angleChange(from, to);
      const quaternion = this._parts.get(name);
      if (quaternion === undefined) return from + s * (to - from);
      const [names, part] = quaternion;
      if (!turns.has(names)) turns.set(names, slerp(names.map(a), names.map(b), s));
      return turns.get(names)[part];
    };
  }
}
