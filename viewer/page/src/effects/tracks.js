// Cross sections of tyre marks in ring buffers.
import { apart } from "./wheels.js";

/** Distance of sections, and the largest distance within a mark, m. */
export const [STEP, GAP] = [0.12, 6];
/** Darkness of a mark of a fully sliding tyre at its usual load. */
const MAX_DARKNESS = 0.8;
/** Load of the darkest mark, N. */
const FULL_LOAD = 1500;

/** Darkness of a mark, 0 to 1: 0 below the limit of the tyre, then rising with slip and load. */
export const darkness = (use, load) => (use <= 1 ? 0 : MAX_DARKNESS * Math.min(1, 0.35 + 0.65 * (use - 1)) * Math.min(1, load / FULL_LOAD));

/** Surfaces with marks; rubber does not adhere to slick or loose ones. */
const MARKED_SURFACES = new Set(["asphalt", "concrete", "paint"]);

/** Ring buffers of sections of all wheels; new sections replace the oldest. */
export class Tracks {
  /** @param {number} wheels number of wheels @param {number} most largest number of sections of a wheel */
  constructor(wheels, most) {
    this.most = most;
    this.rings = Array.from({ length: wheels }, () => ({
      first: 0,
      count: 0,
      open: false,
      /** Rows: earth position of the middle, half width vector, darkness (0: begin of a mark), time. */
      rows: new Float64Array(8 * most),
    }));
    /** Number of changes. */
    this.changes = 0;
    this.epoch = null;
    this.time = -Infinity;
  }

  /** Number of sections of all wheels. */
  get count() {
    return this.rings.reduce((sum, { count }) => sum + count, 0);
  }

  /**
   * @param {import("./wheels.js").Contact[]} contacts of each wheel
   * @param {number} time @param {number} epoch another one interrupts marks and removes those of later times
   */
  update(contacts, time, epoch) {
    if (epoch !== this.epoch || time < this.time) {
      this._removeLater(time);
      this.epoch = epoch;
    }
    this.time = time;
    contacts.forEach((contact, k) => this._extend(this.rings[k], contact, time));
  }

  _extend(ring, contact, time) {
    const dark = contact.touching && MARKED_SURFACES.has(contact.surface) ? darkness(contact.use, contact.load) : 0;
    const last = ring.count > 0 ? this.row(ring, ring.count - 1) : null;
    const distance = last === null ? Infinity : apart(contact.at, last.slice(0, 3));
    if (dark === 0 || (ring.open && distance > GAP)) {
      ring.open = false;
      if (dark === 0) return;
    }
    if (ring.open && distance < STEP) return;
    this._push(ring, contact, ring.open ? dark : 0, time);
    ring.open = true;
  }

  _push(ring, { at, side, width }, dark, time) {
    const slot = (ring.first + ring.count) % this.most;
    if (ring.count === this.most) ring.first = (ring.first + 1) % this.most;
    else ring.count++;
    ring.rows.set([...at, ...side.map((value) => 0.5 * width * value), dark, time], 8 * slot);
    this.changes++;
  }

  /** Row of a section. @returns {Float64Array} */
  row(ring, k) {
    const slot = (ring.first + k) % this.most;
    return ring.rows.subarray(8 * slot, 8 * slot + 8);
  }

  _removeLater(time) {
    for (const ring of this.rings) {
      ring.open = false;
      while (ring.count > 0 && this.row(ring, ring.count - 1)[7] > time) {
        ring.count--;
        this.changes++;
      }
    }
  }
}
