// Numbers of the car by name: columns of the frames, else constants and parameters.
import { Blend, turnsOf } from "../sources/blend.js";

/** The numbers of one car. */
export class Numbers {
  /** @param {Data} hello - First message of the program. */
  constructor({ scene, columns, description, constants = {} }) {
    const variables = description?.variables ?? [];
    this.columns = new Map(columns.map((name, k) => [name, k]));
    const { quaternions, angles } = turnsOf(scene);
    const turns = { quaternions, angles: new Set([...angles, ...variables.filter((v) => v.unit === "rad").map((v) => v.name)]) };
    this._blend = new Blend(turns, new Set(variables.filter((v) => v.type === "Integer").map((v) => v.name)));
    this._fixed = new Map([...variables.map((v) => [v.name, v.start]), ...Object.entries(constants)]);
  }

  /** A constant or a parameter at the start. @param {string} name */
  fixed(name) {
    return this._fixed.get(name);
  }

  /**
   * @param {{before: Data, after: Data, share: number}} shown - Of `Frames`.
   * @returns {(name: string) => number}
   */
  lookup({ before, after, share }) {
    const numbers = (/** @type {Data} */ { values }) => (name) => values[this.columns.get(name)];
    const row = this._blend.lookup(numbers(before), numbers(after), share);
    return (name) => (this.columns.has(name) ? row(name) : Number(this._fixed.get(name) ?? NaN));
  }
}
