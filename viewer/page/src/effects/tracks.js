// The marks that tyres leave, as rings of cross sections; pure numbers.
import { apart } from "./wheels.js";

/** Metres between two sections, and the way after which a mark begins again. */
export const [STEP, GAP] = [0.12, 6];
/** Darkness of a mark when the tyre slides altogether under its usual load. */
const DARKEST = 0.8;
/** Load that presses a full mark, in newton. */
const LOAD = 1500;

/** How dark a mark is, 0 to 1: nothing below the limit, more the more it is passed and the more it is loaded. */
export const darkness = (use, load) => (use <= 1 ? 0 : DARKEST * Math.min(1, 0.35 + 0.65 * (use - 1)) * Math.min(1, load / LOAD));

/** Surfaces that take a mark: rubber does not stay on what is slick or loose. */
const MARKED = new Set(["asphalt", "concrete", "paint"]);

/** A ring of sections of all wheels; the oldest are written over. */
export class Tracks {
  /** @param {number} wheels @param {number} most sections of a wheel */
  constructor(wheels, most) {
    this.most = most;
    this.rings = Array.from({ length: wheels }, () => ({
      first: 0,
      count: 0,
      open: false,
      /** A section: earth position of its middle, half width across (x, y, z), darkness, time; 0 of darkness begins one. */
      rows: new Float64Array(8 * most),
    }));
    /** One more whenever something has changed. */
    this.changes = 0;
    this.epoch = null;
    this.time = -Infinity;
  }

  /** Sections of all wheels. */
  get count() {
    return this.rings.reduce((sum, { count }) => sum + count, 0);
  }

  /**
   * @param {import("./wheels.js").Contact[]} contacts one a wheel
   * @param {number} time @param {number} epoch another one: nothing goes on across it, and marks of later times are gone
   */
  update(contacts, time, epoch) {
    if (epoch !== this.epoch || time < this.time) {
      this._back(time);
      this.epoch = epoch;
    }
    this.time = time;
    contacts.forEach((contact, k) => this._mark(this.rings[k], contact, time));
  }

  _mark(ring, contact, time) {
    const dark = contact.touching && MARKED.has(contact.surface) ? darkness(contact.use, contact.load) : 0;
    const last = ring.count > 0 ? this.row(ring, ring.count - 1) : null;
    const far = last === null ? Infinity : apart(contact.at, last.slice(0, 3));
    if (dark === 0 || (ring.open && far > GAP)) {
      ring.open = false;
      if (dark === 0) return;
    }
    if (ring.open && far < STEP) return;
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

  /** The numbers of a section. @returns {Float64Array} */
  row(ring, k) {
    const slot = (ring.first + k) % this.most;
    return ring.rows.subarray(8 * slot, 8 * slot + 8);
  }

  _back(time) {
    for (const ring of this.rings) {
      ring.open = false;
      while (ring.count > 0 && this.row(ring, ring.count - 1)[7] > time) {
        ring.count--;
        this.changes++;
      }
    }
  }
}
