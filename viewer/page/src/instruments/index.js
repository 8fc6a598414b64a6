// The instruments of a car on all pages: speed, gear, pedals, the four tyres, a map.
import { el } from "../common/dom.js";
import { styled } from "../styles.js";
import { Cluster } from "./cluster.js";
import { WorldMap } from "./map.js";
import style from "./style.css";
import { frictionOf } from "./surfaces.js";
import { Tyres, wheelsOf } from "./tyres.js";
import { WorldPlan } from "./world_plan.js";

/** Least time between two drawings of the small map, s. */
const MAP_INTERVAL = 0.1;

/** The instruments over the picture of a car, as far as there are signals for them. */
export class Instruments {
  /**
   * @param {Set<string>} names of the signals
   * @param {object} options
   * @param {Data} options.scene with roads and scenery
   * @param {Data} [options.world] name, places and bounds
   * @param {(name: string) => unknown} [options.fixed] values of constants and parameters; undefined: not known
   */
  constructor(names, { scene, world, fixed = () => undefined }) {
    styled(style);
    this.plan = new WorldPlan(scene, world);
    this.cluster = new Cluster(names);
    this.tyres = new Tyres(wheelsOf(names), (at, wheel) => frictionOf(this.plan.surfaces, fixed, at, wheel));
    this.inset = new WorldMap(this.plan);
    const { position, quaternion } = scene.frames?.[scene.focus] ?? {};
    this._place = position ?? ["chassis.x", "chassis.y"];
    this._quaternion = quaternion;
    this._mapTime = -Infinity; // time of the last drawing of the small map, s
    this._hidden = false;
  }

  /** Whether signals are those of a car. @param {Set<string>} names */
  static of(names) {
    return names.has("speed") && wheelsOf(names).length > 0;
  }

  /** Layer with all instruments for a picture. @returns {HTMLElement} */
  layer() {
    const { pictures, scenery } = this.plan;
    const map = pictures.length + scenery.length > 0 ? [this.inset.element] : []; // a map of a plain road would be empty
    return el("div.a3-instruments", { data: "instruments" }, ...map, this.tyres.element, this.cluster.element);
  }

  /** Position, m, and heading, rad, of the car on a map. @param {(name: string) => number} lookup */
  car(lookup) {
    const [x, y] = this._place.slice(0, 2).map(lookup);
    return { x, y, yaw: this._heading(lookup) };
  }

  /** @param {(name: string) => number} lookup @param {{x: number, y: number, yaw: number}} [car] its position, if already known */
  show(lookup, car = this.car(lookup)) {
    this.cluster.show(lookup);
    this.tyres.show(lookup);
    this.plan.trail.add(car.x, car.y);
    const now = performance.now() / 1000;
    if (now - this._mapTime < MAP_INTERVAL || this.inset.element.hidden) return;
    this._mapTime = now;
    this.inset.show(car);
  }

  /** Shows or hides the instruments. */
  toggle() {
    this._hidden = !this._hidden;
    for (const { element } of [this.cluster, this.tyres, this.inset]) element.style.visibility = this._hidden ? "hidden" : "";
  }

  _heading(lookup) {
    if (!this._quaternion) return lookup("chassis.yaw") || 0;
    const [w, x, y, z] = this._quaternion.map(lookup);
    return Math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
  }
}
