// Numbers between two rows: straight, but angles the short way round and quaternions as one rotation.

/** What turns: columns that are angles, and those of quaternions by four. @typedef {{angles: Set<string>, quaternions: string[][]}} Turns */

/**
 * Columns of a scene that turn.
 * @param {Data} scene
 * @returns {Turns}
 */
export function turnsOf(scene) {
  const frames = Object.values(scene.frames ?? {});
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

/** Numbers between rows of the same columns. */
export class Blend {
  /**
   * @param {Map<string, number>} columns - Index in a row by name.
   * @param {Partial<Turns>} [turns]
   * @param {Set<string>} [whole] - Names of whole numbers: those of the nearer row count.
   */
  constructor(columns, { angles = new Set(), quaternions = [] } = {}, whole = new Set()) {
    this.columns = columns;
    this._angles = angles;
    this._whole = whole;
    this._four = new Map();
    for (const names of quaternions) {
      const indices = names.map((name) => columns.get(name));
      if (indices.every((index) => index !== undefined)) for (const name of names) this._four.set(name, indices);
    }
  }

  /**
   * @param {ArrayLike<number>} a - Row before.
   * @param {ArrayLike<number>} b - Row after.
   * @param {number} s - From 0 to 1.
   * @returns {(name: string) => number} NaN where there is no such column.
   */
  lookup(a, b, s) {
    return (name) => {
      const index = this.columns.get(name);
      if (index === undefined) return NaN;
      const [from, to] = [a[index], b[index]];
      if (s === 0 || s === 1) return s === 0 ? from : to;
      if (this._whole.has(name)) return s < 0.5 ? from : to;
      if (this._angles.has(name)) return from + s * turned(from, to);
      const four = this._four.get(name);
      // The sign of a quaternion means nothing: both ends are taken on the same side.
      const sign = four && four.reduce((sum, k) => sum + a[k] * b[k], 0) < 0 ? -1 : 1;
      return from + s * (sign * to - from);
    };
  }
}
