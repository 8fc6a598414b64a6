// Computes the levels and pitches of all sounds from the signals of a car.
import * as signals from "./signals.js";

const PREFIX = /^(.+)\.slip_angle$/;
/** Radius of a wheel, m, and the longest time between pictures for which changes of load are impacts, s. */
const [WHEEL_RADIUS, MAX_INTERVAL] = [0.3, 0.2];

/** Computes sounds from the available signals; stores the last loads. */
export class CarMix {
  /** @param {string[]} columns @param {Object<string, number>} [constants] */
  constructor(columns, constants = {}) {
    const has = new Set(columns);
    this.wheels = columns.flatMap((name) => {
      const prefix = PREFIX.exec(name)?.[1];
      return prefix !== undefined && has.has(`${prefix}.slip`) && has.has(`${prefix}.Fz`) ? [prefix] : [];
    });
    this.engine = has.has("engine_speed");
    this.motor = has.has("motor_speed");
    this.speed = has.has("speed");
    this.throttle = ["used.throttle", "throttle"].find((name) => has.has(name));
    this.torque = has.has("motor_torque") ? "motor_torque" : null;
    this.most = constants["drive.max_torque"] ?? 200;
    this.loads = null;
    this.time = null;
    /** Reason why nothing is audible; empty if there is sound. */
    this.problem =
      this.engine || this.motor || this.speed || this.wheels.length > 0
        ? ""
        : "The FMU has none of the outputs engine_speed, motor_speed, speed and the slips of wheels, so nothing is heard.";
  }

  /**
   * @param {(name: string) => number | undefined} lookup
   * @param {number} time of the run, s; unchanged: paused
   * @returns {import("./mixer.js").Mix | null} null: silence
   */
  at(lookup, time) {
    const number = (name) => {
      const value = lookup(name);
      return Number.isFinite(value) ? value : 0;
    };
    const step = this.time === null ? 0 : time - this.time;
    this.time = time;
    const wheels = this.wheels.map((prefix) => ({
      load: number(`${prefix}.Fz`),
      slip: number(`${prefix}.slip`),
      angle: number(`${prefix}.slip_angle`),
      tread: Math.abs(number(`${prefix}.omega`)) * WHEEL_RADIUS,
    }));
    const before = this.loads;
    this.loads = wheels.map(({ load }) => load);
    if (step <= 0) return null;
    const speed = Math.abs(number("speed"));
    const throttle = this.throttle === undefined ? 0 : number(this.throttle);
    const squeals = wheels.map(({ slip, angle, load, tread }) => signals.squealLevel(slip, angle, load, Math.max(speed, tread)));
    const loudest = squeals.indexOf(Math.max(...squeals, 0));
    const touching = wheels.length > 0 ? wheels.filter(({ load }) => load > 0).length / wheels.length : 1;
    const thumps = before === null || step > MAX_INTERVAL ? [] : wheels.map(({ load }, k) => signals.thumpLevel(before[k], load, step));
    return {
      engine: this.engine ? { pitch: signals.enginePitch(number("engine_speed")), ...signals.engineLevels(number("engine_speed"), throttle) } : null,
      motor: this.motor ? this._motor(number, throttle) : null,
      squeal: {
        level: Math.min(1, Math.hypot(...squeals, 0)),
        pitch: signals.squealPitch(loudest >= 0 ? wheels[loudest].load : 1500),
      },
      rolling: { level: signals.rollingLevel(speed, touching), pitch: 160 + 9 * speed },
      wind: { level: signals.windLevel(speed), pitch: 400 + 14 * speed },
      thumps: thumps.filter((strength) => strength > 0),
    };
  }

  _motor(number, throttle) {
    const speed = number("motor_speed");
    const effort = this.torque === null ? throttle : number(this.torque) / this.most;
    return { pitch: signals.motorPitch(speed), level: signals.motorLevel(speed, effort) };
  }
}
