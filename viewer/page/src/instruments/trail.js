// The path of the car on a map.

/** Distance of points of the trail, m, and their largest number. */
const [SPACING, MAX_POINTS] = [1.5, 4000];
/** Share of the points that is removed at the largest number, from the oldest on. */
const REMOVED_SHARE = 0.1;

/** The thinned path of the car, interrupted where it was moved to another position. */
export class Trail {
  constructor() {
    this.points = []; // [x, y], or null for an interruption
    /** @type {{time: number, epoch: number} | undefined} */
    this.now = undefined;
  }

  /** @param {number} x @param {number} y */
  add(x, y) {
    const last = this.points[this.points.length - 1];
    if (!Number.isFinite(x + y) || (last && Math.hypot(x - last[0], y - last[1]) < SPACING)) return;
    this.points.push([x, y]);
    if (this.points.length > MAX_POINTS) this.points.splice(0, REMOVED_SHARE * MAX_POINTS);
  }

  /**
   * Sets the time of the next point; the trail is interrupted if time goes back, jumps, or the epoch changes.
   * @param {number} time s @param {number} epoch @param {number} longest s
   */
  at(time, epoch, longest) {
    const { time: before, epoch: last } = this.now ?? { time, epoch };
    if (time < before || time - before > longest || epoch !== last) this.lift();
    this.now = { time, epoch };
  }

  /** Interrupts the trail. */
  lift() {
    if (this.points.length && this.points[this.points.length - 1]) this.points.push(null);
  }
}
