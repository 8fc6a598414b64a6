// Motion of particles that slow down, grow and fade, in a buffer of fixed size.
import { randomNumbers } from "../common/random.js";

/** Kinds of particles: life, s; sizes at begin and end, m; linear colour; opacity; downward acceleration, m/s2; share of the wheel's velocity. */
export const KINDS = {
  grass: { life: 0.9, sizes: [0.15, 0.7], colour: [0.16, 0.13, 0.07], seen: 0.55, fall: 5, carried: 0.22 },
  dust: { life: 2.2, sizes: [0.3, 2.4], colour: [0.42, 0.37, 0.3], seen: 0.42, fall: 0.4, carried: 0.22 },
  spray: { life: 0.8, sizes: [0.15, 1.3], colour: [0.62, 0.67, 0.72], seen: 0.3, fall: 4, carried: 0.45 },
  smoke: { life: 1.6, sizes: [0.3, 1.8], colour: [0.55, 0.56, 0.58], seen: 0.25, fall: -0.5, carried: 0.22 },
};

/**
 * What surfaces throw up: particles a second for each m/s by which the wheel is faster than a speed, and by which its tread
 * slides faster than another one, m/s; `use` of friction from which they do.
 */
const LOOSE = { kind: "dust", rolling: [5, 4], sliding: [25, 0.5] };
const HARD = { kind: "smoke", rolling: [0, 0], sliding: [8, 3], use: 2 };
const THROWN = {
  ...{ gravel: LOOSE, dirt: LOOSE, asphalt: HARD, concrete: HARD },
  grass: { kind: "grass", rolling: [2.5, 12], sliding: [25, 0.5] },
  wet: { kind: "spray", rolling: [7, 4], sliding: [0, 0] },
};
const NOTHING = { kind: "dust", rolling: [0, 0], sliding: [0, 0] };
/** Largest number of particles of a wheel per second, and load from which it throws all of them, N. */
const [MAX_RATE, FULL_LOAD] = [120, 800];
/** Damping of the motion of particles, 1/s; longest step of it, s; height at which they begin, m. */
const [DAMPING, MAX_STEP, START_HEIGHT] = [1.6, 0.1, 0.06];
/** Speed of particles beside that of the wheel: constant part, m/s, factor of the wheel's speed, and ratio of sideways to upward. */
const [LEAST_SPEED, SPEED_FACTOR, SIDEWAYS] = [0.6, 0.05, 1.2];
/** Numbers of a particle: position, velocity, age; index of the age. */
export const [ROW, AGE] = [7, 6];

/**
 * Kind of the particles that a wheel throws up, and their number per second.
 * @param {import("./wheels.js").Contact} contact
 * @returns {{kind: string, rate: number}}
 */
export function thrown({ touching, surface, speed, sliding, use, load }) {
  const law = THROWN[surface] ?? NOTHING;
  if (!touching || use <= (law.use ?? -1)) return { kind: law.kind, rate: 0 };
  const beyond = (value, [rate, least]) => rate * Math.max(0, value - least);
  return { kind: law.kind, rate: Math.min(MAX_RATE, beyond(speed, law.rolling) + beyond(sliding, law.sliding)) * Math.min(1, load / FULL_LOAD) };
}

/** A ring buffer of particles. */
export class Cloud {
  /** @param {number} wheels number of wheels @param {number} most largest number of particles */
  constructor(wheels, most) {
    this.most = most;
    /** Rows in earth axes; an age beyond the life means no particle. */
    this.rows = new Float64Array(ROW * most).fill(Infinity);
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
    for (let k = 0; k < this.most; k++) if (this.rows[ROW * k + AGE] < KINDS[this.kinds[k]].life) sum++;
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
    const step = Math.min(time - this.time, MAX_STEP);
    this.time = time;
    if (!(step > 0)) return; // paused
    this._move(step, up);
    contacts.forEach((contact, k) => this._emit(contact, k, step, up));
  }

  _move(step, up) {
    const { rows } = this;
    for (let k = 0; k < this.most; k++) {
      const i = ROW * k;
      if (rows[i + AGE] === Infinity) continue;
      const { life, fall } = KINDS[this.kinds[k]];
      rows[i + AGE] += step;
      if (rows[i + AGE] > life) {
        rows[i + AGE] = Infinity;
        continue;
      }
      const decay = Math.exp(-DAMPING * step);
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
      const agitation = LEAST_SPEED + SPEED_FACTOR * contact.speed;
      const i = ROW * this.next;
      for (let axis = 0; axis < 3; axis++) {
        this.rows[i + axis] = contact.at[axis] - share * step * travel[axis] + contact.side[axis] * contact.width * spread() + START_HEIGHT * up[axis];
        this.rows[i + 3 + axis] = KINDS[kind].carried * travel[axis] + agitation * ((0.5 + this.draw()) * up[axis] + SIDEWAYS * spread());
      }
      this.rows[i + AGE] = 0;
      this.kinds[this.next] = kind;
      this.next = (this.next + 1) % this.most;
    }
  }
}
