// Motion of particles that slow down, grow and fade, in a buffer of fixed size.
import { randomNumbers } from "../common/random.js";

/** Kinds of particles: life, s; sizes at begin and end, m; linear colour; opacity; downward acceleration, m/s2. */
export const KINDS = {
  grass: { life: 0.9, sizes: [0.15, 0.7], colour: [0.16, 0.13, 0.07], seen: 0.55, fall: 5 },
  dust: { life: 2.2, sizes: [0.3, 2.4], colour: [0.42, 0.37, 0.3], seen: 0.42, fall: 0.4 },
  spray: { life: 0.8, sizes: [0.15, 1.3], colour: [0.62, 0.67, 0.72], seen: 0.3, fall: 4 },
  smoke: { life: 1.6, sizes: [0.3, 1.8], colour: [0.55, 0.56, 0.58], seen: 0.25, fall: -0.5 },
};

/**
 * Kind of the particles that a wheel throws up, and their number per second.
 * @param {import("./wheels.js").Contact} contact
 * @returns {{kind: string, rate: number}}
 */
export function thrown({ touching, surface, speed, sliding, use, load }) {
  const none = { kind: "dust", rate: 0 };
  if (!touching) return none;
  const most = (rate) => Math.min(120, rate) * Math.min(1, load / 800);
  if (surface === "gravel" || surface === "dirt") return { kind: "dust", rate: most(5 * Math.max(0, speed - 4) + 25 * Math.max(0, sliding - 0.5)) };
  if (surface === "grass") return { kind: "grass", rate: most(2.5 * Math.max(0, speed - 12) + 25 * Math.max(0, sliding - 0.5)) };
  if (surface === "wet") return { kind: "spray", rate: most(7 * Math.max(0, speed - 4)) };
  if (surface === "asphalt" || surface === "concrete") return { kind: "smoke", rate: use > 2 ? most(8 * Math.max(0, sliding - 3)) : 0 };
  return none;
}

/** A ring buffer of particles. */
export class Cloud {
  /** @param {number} wheels number of wheels @param {number} most largest number of particles */
  constructor(wheels, most) {
    this.most = most;
    /** Rows of position, velocity and age in earth axes; an age beyond the life means no particle. */
    this.rows = new Float64Array(7 * most).fill(Infinity);
    this.kinds = new Array(most).fill("dust");
    this.next = 0;
    this.owed = new Float64Array(wheels);
    this.last = new Array(wheels).fill(null);
    this.time = null;
    this.epoch = null;
    this.draw = randomNumbers(99);
  }

  /** Number of particles in the air. */
  get count() {
    let sum = 0;
    for (let k = 0; k < this.most; k++) if (this.rows[7 * k + 6] < KINDS[this.kinds[k]].life) sum++;
    return sum;
  }

  /**
   * @param {import("./wheels.js").Contact[]} contacts of each wheel @param {number[]} up
   * @param {number} time an earlier time, or another epoch, removes all particles
   * @param {number} epoch
   */
  update(contacts, up, time, epoch) {
    if (epoch !== this.epoch || this.time === null || time < this.time) {
      this.rows.fill(Infinity);
      this.last.fill(null);
      this.owed.fill(0);
      this.time = time;
    }
    this.epoch = epoch;
    const step = Math.min(time - this.time, 0.1);
    this.time = time;
    if (!(step > 0)) return; // paused
    this._move(step, up);
    contacts.forEach((contact, k) => this._emit(contact, k, step, up));
  }

  _move(step, up) {
    const { rows } = this;
    for (let k = 0; k < this.most; k++) {
      const i = 7 * k;
      if (rows[i + 6] === Infinity) continue;
      const { life, fall } = KINDS[this.kinds[k]];
      rows[i + 6] += step;
      if (rows[i + 6] > life) {
        rows[i + 6] = Infinity;
        continue;
      }
      const decay = Math.exp(-1.6 * step);
      for (let axis = 0; axis < 3; axis++) {
        rows[i + 3 + axis] = rows[i + 3 + axis] * decay - fall * step * up[axis];
        rows[i + axis] += step * rows[i + 3 + axis];
      }
    }
  }

  _emit(contact, wheel, step, up) {
    const before = this.last[wheel];
    this.last[wheel] = contact.touching ? [...contact.at] : null;
    const { kind, rate } = thrown(contact);
    if (rate === 0 || before === null) return;
    this.owed[wheel] += rate * step;
    const travel = contact.at.map((value, axis) => (value - before[axis]) / step);
    for (; this.owed[wheel] >= 1; this.owed[wheel]--) {
      const share = this.draw();
      const spread = () => this.draw() - 0.5;
      const slide = kind === "spray" ? 0.45 : 0.22;
      const agitation = 0.6 + 0.05 * contact.speed;
      const i = 7 * this.next;
      for (let axis = 0; axis < 3; axis++) {
        this.rows[i + axis] = contact.at[axis] - share * step * travel[axis] + contact.side[axis] * contact.width * spread() + 0.06 * up[axis];
        this.rows[i + 3 + axis] = slide * travel[axis] + agitation * ((0.5 + this.draw()) * up[axis] + 1.2 * spread());
      }
      this.rows[i + 6] = 0;
      this.kinds[this.next] = kind;
      this.next = (this.next + 1) % this.most;
    }
  }
}
