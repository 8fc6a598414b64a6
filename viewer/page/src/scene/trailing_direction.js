// A direction that follows another one like a thing on a rope: a camera that does not turn with every jerk.
import { add, dot, scale, subtract, unit } from "./math.js";

/** After this long without a picture, s, the direction is taken as it is. */
const PAUSE = 1;

/** A level direction with a lag. */
export class TrailingDirection {
  /** @param {number} lag - Time constant, s; 0: none. @param {() => number} [clock] - s. */
  constructor(lag, clock = () => performance.now() / 1000) {
    this.lag = lag;
    this.clock = clock;
    this.way = null;
    this.at = -Infinity;
  }

  /**
   * The direction now.
   * @param {number[]} forward - Unit vector that is followed, level.
   * @param {number[]} up - Unit vector.
   * @returns {number[]} Unit vector, level.
   */
  along(forward, up) {
    if (!(this.lag > 0)) return forward;
    const now = this.clock();
    const passed = now - this.at;
    this.at = now;
    if (this.way === null || passed > PAUSE) this.way = forward;
    const share = 1 - Math.exp(-passed / this.lag);
    const mixed = add(scale(this.way, 1 - share), scale(forward, share));
    this.way = unit(subtract(mixed, scale(up, dot(mixed, up)))) ?? forward;
    return this.way;
  }

  /** What is followed was put elsewhere. */
  snap() {
    this.way = null;
  }
}
