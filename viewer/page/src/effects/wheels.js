// Contact point, slip and surface of each tyre of a scene.
import { surfaceOf } from "../looks/heights.js";
import { cross, finite, subtract, unit } from "../scene/math.js";
import { tyresOf } from "../scene/tyres.js";

/** Slips of the largest force of a car tyre, longitudinal and lateral (TMeasy: max_slip of the cars of this package). */
export const LIMITS = { slip: 0.139, lateral: 0.15 };
/** Load below which a tyre has no marks, dust and sound, N. */
export const LIGHT = 150;
/** Speed below which slip, a quotient of small numbers, is ignored, m/s. */
const MIN_SPEED = 0.3;

/**
 * Combined slip over the slip of the largest force; above 1 a tyre slides.
 * @param {number} slip longitudinal, positive when driven @param {number} angle slip angle, rad
 */
export const use = (slip, angle) => Math.hypot(slip / LIMITS.slip, Math.tan(Math.min(Math.abs(angle), 1.5)) / LIMITS.lateral);

/**
 * State of the contact of a wheel; `touching` is false in the air and if a value is missing.
 * @typedef {{touching: boolean, at: number[], normal: number[], side: number[], load: number, use: number, slip: number, sliding: number,
 *   speed: number, surface: string, width: number, radius: number}} Contact
 *   side: lateral unit vector; sliding: speed of the tread over the ground, m/s; speed: of the wheel, m/s
 */

/** The wheels of a scene whose tyre forces are arrows in it. */
export class Wheels {
  /**
   * @param {Data} scene
   * @param {{surface?: (x: number, y: number) => string, columns?: string[]}} [options] columns: names of
   *   the signals, if they are known
   */
  constructor(scene, options = {}) {
    this.surface = options.surface ?? surfaceOf(scene);
    this.list = tyresOf(scene).map(({ tyre, slips, shape }) => {
      return { tyre, slips, frame: shape?.frame, width: shape?.width ?? 0.18, radius: shape?.radius ?? 0.3 };
    });
    /** Reason why contacts are not known: no tyres, or no columns of slips; empty if they are. */
    this.problem = this.list.length > 0 ? this._problemOf(options.columns) : "The scene has no tyres, so there are no marks and no dust.";
  }

  /** @param {string[] | undefined} columns */
  _problemOf(columns) {
    const missing = this.list.flatMap(({ slips: { slip, slip_angle: angle } }) => [slip, angle].filter((name) => !columns?.includes(name)));
    if (columns === undefined || missing.length === 0) return "";
    return `There are no numbers ${[...new Set(missing)].join(", ")}, so these tyres leave no marks, throw up no dust and are not heard.`;
  }

  /** @param {(name: string) => number | undefined} lookup @returns {Contact[]} of each wheel */
  contacts(lookup) {
    const speed = Math.abs(lookup(this.list[0]?.slips.speed) ?? 0);
    return this.list.map((wheel) => this._contact(wheel, lookup, speed));
  }

  _contact({ tyre, slips, width, radius }, lookup, speed) {
    const [at, normal, axis] = [tyre.contact, tyre.normal, tyre.axis].map((names) => names.map((name) => lookup(name)));
    const load = lookup(tyre.forces[2]);
    const [slip, angle] = [lookup(slips.slip), lookup(slips.slip_angle)];
    const none = { touching: false, at, normal, side: [0, 1, 0], load: 0, use: 0, slip: 0, sliding: 0, speed: 0, surface: "asphalt", width, radius };
    if (!finite([...at, ...normal, ...axis, load, slip, angle]) || load < LIGHT) return none;
    const ahead = unit(cross(axis, normal));
    const side = ahead && unit(cross(normal, ahead));
    if (!side) return none;
    const rolling = Math.abs(lookup(slips.omega) ?? 0) * radius;
    const fastest = Math.max(speed, rolling);
    const sliding = Math.hypot(slip * fastest, Math.sin(angle) * speed);
    return {
      touching: true, at, normal, side, load, slip, sliding, width, radius, speed: fastest,
      use: fastest > MIN_SPEED ? use(slip, angle) : 0,
      surface: this.surface(at[0], at[1]),
    }; // prettier-ignore
  }
}

/** Distance of two points. @param {ArrayLike<number>} a @param {ArrayLike<number>} b */
export const apart = (a, b) => Math.hypot(...subtract(a, b));
