// Interpolates numbers between two instants: linearly, angles by the shorter turn and quaternions by the shorter arc.
import { Quaternion } from "three";

/** What turns: columns that are angles, and those of quaternions by four. @typedef {{angles: Set<string>, quaternions: string[][]}} Turns */

/**
 * Columns of a scene that turn.
 * @param {Data | null | undefined} scene
 * @returns {Turns}
 */
export function turnsOf(scene) {
  const frames = Object.values(scene?.frames ?? {});
  const quaternions = frames.map((frame) => frame.quaternion).filter(Boolean);
  const angles = new Set(frames.map((frame) => frame.angle).filter((angle) => typeof angle === "string"));
  return { angles, quaternions };
}

/**
 * The change of an angle from one row to the next. An angle between -pi and pi may jump from one end to the other; one
 * that counts turns goes on.
 */
function turned(a, b) {
  const change = b - a;
  const wrapped = Math.abs(change) > Math.PI && Math.max(Math.abs(a), Math.abs(b)) < Math.PI + 1e-6;
  return wrapped ? change - 2 * Math.PI * Math.sign(change) : change;
}

/**
 * Between two orientations along the shorter arc; q and -q are the same one.
 * @param {number[]} a @param {number[]} b quaternions, of any length but zero
 * @param {number} share
 * @returns {number[]} unit quaternion
 */
export function slerp(a, b, share) {
  const [from, to] = [a, b].map((parts) => {
    const [w, x, y, z] = parts.map((part) => part / Math.hypot(...parts)); // three.js takes one of zeros for no turn
    return new Quaternion(x, y, z, w);
  });
  const { x, y, z, w } = from.slerp(to, share);
  return [w, x, y, z];
}

/** Numbers between instants of the same columns. */
export class Blend {
  /** Names of the four parts of a quaternion and which one, by the name of the part. @type {Map<string, [string[], number]>} */
  _parts = new Map();

  /** @param {Partial<Turns>} [turns] @param {Set<string>} [whole] names of whole numbers: those of the nearer instant count */
  constructor({ angles = new Set(), quaternions = [] } = {}, whole = new Set()) {
    this._angles = angles;
    this._whole = whole;
    for (const names of quaternions) names.forEach((name, part) => this._parts.set(name, [names, part]));
  }

  /**
   * @param {(name: string) => number | undefined} a numbers before @param {(name: string) => number | undefined} b after
   * @param {number} s from 0 to 1
   * @returns {(name: string) => number | undefined}
   */
  lookup(a, b, s) {
    if (s === 0 || s === 1) return s === 0 ? a : b;
    const turns = new Map();
    return (name) => {
      const [from, to] = [a(name), b(name)];
      if (from === undefined || to === undefined) return undefined;
      if (this._whole.has(name)) return s < 0.5 ? from : to;
      if (this._angles.has(name)) return from + s * turned(from, to);
      const four = this._parts.get(name);
      if (four === undefined) return from + s * (to - from);
      const [names, part] = four;
      if (!turns.has(names)) turns.set(names, slerp(names.map(a), names.map(b), s));
      return turns.get(names)[part];
    };
  }
}
