// Numbers of the car by name: columns of the frames, else constants and parameters; where it is and what it stands on.
import { Blend, turnsOf } from "../live/blend.js";

/** Friction of a road that tells none, under a car without that parameter. */
const FRICTION = 1.0;

/** The numbers of one car. */
export class Numbers {
  /**
   * @param {Data} hello - First message of the program.
   * @param {import("./surfaces.js").Surfaces} surfaces - Of the world.
   */
  constructor({ scene, columns, description, constants = {} }, surfaces) {
    const variables = description?.variables ?? [];
    this.columns = new Map(columns.map((name, k) => [name, k]));
    const { quaternions, angles } = turnsOf(scene);
    const turns = { quaternions, angles: new Set([...angles, ...variables.filter((v) => v.unit === "rad").map((v) => v.name)]) };
    this._blend = new Blend(this.columns, turns, new Set(variables.filter((v) => v.type === "Integer").map((v) => v.name)));
    this._fixed = new Map([...variables.map((v) => [v.name, v.start]), ...Object.entries(constants)]);
    this._surfaces = surfaces;
    const { position, quaternion } = scene.frames?.[scene.focus] ?? {};
    this._place = position ?? ["chassis.x", "chassis.y"];
    this._quaternion = quaternion;
  }

  /**
   * @param {{before: Data, after: Data, share: number}} shown - Of `Frames`.
   * @returns {(name: string) => number}
   */
  lookup({ before, after, share }) {
    const row = this._blend.lookup(before.values, after.values, share);
    return (name) => (this.columns.has(name) ? row(name) : Number(this._fixed.get(name) ?? NaN));
  }

  /** Place and heading of the car on a map, m and rad. @param {(name: string) => number} lookup */
  car(lookup) {
    const [x, y] = this._place.slice(0, 2).map(lookup);
    return { x, y, yaw: this._heading(lookup) };
  }

  /**
   * Largest longitudinal force of a wheel's tyre over its load on the road at a place of the earth.
   * @param {number} x @param {number} y @param {string} wheel - Its name, which ends as in wheel_FL.
   */
  friction(x, y, wheel) {
    const axle = wheel.at(-2) === "R" ? "rear" : "front";
    const number = (/** @type {string} */ name, /** @type {number} */ other) => Number(this._fixed.get(name) ?? other);
    const there = this._surfaces.friction(x, y);
    const road = Number.isFinite(there) ? there : number("road.friction", FRICTION);
    return road * number("road.friction_factor", 1) * number(`vehicle.tyre_friction_${axle}`, 1) * number(`${axle}.tyre.grip`, 1);
  }

  _heading(lookup) {
    if (!this._quaternion) return lookup("chassis.yaw") || 0;
    const [w, x, y, z] = this._quaternion.map(lookup);
    return Math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
  }
}
