// A direction that follows another one with a first-order lag, for smooth motion of a camera.
import { add, perpendicular, scale } from "./math.js";

/** Time without a picture after which the lag is discarded, s. */
const MAX_PAUSE = 1;

/** A horizontal direction with a lag. */
export class TrailingDirection {
  /** @param {number} lag time constant, s; 0: none @param {() => number} [clock] s */
  constructor(lag, clock = () => performance.now() / 1000) {
    this.lag = lag;
    this.clock = clock;
    this.direction = null;
    this.last = -Infinity;
  }

  /**
   * Current direction.
   * @param {number[]} forward followed horizontal unit vector
   * @param {number[]} up unit vector
   * @returns {number[]} horizontal unit vector
   */
  along(forward, up) {
    if (!(this.lag > 0)) return forward;
    const now = this.clock();
    const elapsed = now - this.last;
    this.last = now;
    if (this.direction === null || elapsed > MAX_PAUSE) this.direction = forward;
    const share = 1 - Math.exp(-elapsed / this.lag);
    const mixed = add(scale(this.direction, 1 - share), scale(forward, share));
    this.direction = perpendicular(mixed, up) ?? forward;
    return this.direction;
  }

  /** Discard the lag: the car was moved to another position. */
  snap() {
    this.direction = null;
  }
}
