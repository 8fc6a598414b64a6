// Driving by keys: pedals and steering wheel move at limited rates and return when the key is released.
import { DRIVING } from "../common/key_table.js";

/** Largest changes per second of simulated time: with the key pressed, and released. */
export const RATES = { steering: [1.6, 3.0], throttle: [2.5, 5.0], brake: [4.0, 8.0], hand_brake: [8.0, 8.0] };
/** Lateral acceleration of full steering by a key, m/s2. */
const LATERAL_ACCELERATION = 9.0;
/** Defaults for FMUs without these constants, m and rad. */
const WHEELBASE = 2.5;
const WHEEL_ANGLE = 0.55;

/** Positions of the selector by action. */
const SELECTOR = { reverse: -1, neutral: 0, drive: 1 };

/** Inputs requested by pressed keys. */
export class Keyboard {
  /** @param {Object<string, number>} constants of the FMU, by name */
  constructor(constants = {}) {
    this._down = new Set();
    this._wheelbase = constants["vehicle.wheelbase"] ?? WHEELBASE;
    this._angle = constants["vehicle.front_wheel_angle_max"] ?? WHEEL_ANGLE;
  }

  /**
   * Handles a key press or release.
   * @param {string} code as in `KeyboardEvent.code`
   * @param {boolean} down
   * @param {boolean} [shift]
   * @returns {{used: boolean, selector?: number}} whether it is a key for driving
   */
  key(code, down, shift = false) {
    const act = (down && shift && DRIVING[`Shift+${code}`]) || DRIVING[code];
    if (!act) return { used: false };
    if (act in SELECTOR) return down ? { used: true, selector: SELECTOR[act] } : { used: true };
    this._down[down ? "add" : "delete"](code);
    return { used: true };
  }

  /** Releases all keys, as when the page loses the focus. */
  clear() {
    this._down.clear();
  }

  /** Share of full lock for a key, limited by the lateral acceleration at a speed, m/s. */
  steeringLimit(speed) {
    const angle = (LATERAL_ACCELERATION * this._wheelbase) / Math.max(speed * speed, 1e-6);
    return Math.min(1, Math.max(0.02, angle / this._angle));
  }

  /**
   * Requested values.
   * @param {number} speed of the car, m/s
   * @returns {[string, number, number][]} input, value, rate
   */
  wants(speed) {
    const acts = new Set([...this._down].map((code) => DRIVING[code]));
    const limit = this.steeringLimit(speed);
    const steering = limit * ((acts.has("left") ? 1 : 0) - (acts.has("right") ? 1 : 0));
    const inputs = { steering };
    for (const pedal of ["throttle", "brake", "hand_brake"]) inputs[pedal] = acts.has(pedal) ? 1 : 0;
    return Object.entries(inputs).map(([name, value]) => {
      const [to, back] = RATES[name];
      return [name, value, value === 0 ? back : to];
    });
  }
}
