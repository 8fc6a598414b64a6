// Computes displacement and stress of a flexible body from the amplitudes of its modes.
import { floats } from "../bytes.js";

/** Displacement and stress of a flexible body. */
export class Bending {
  /** @param {Data} body an entry of `flexible` of a scene */
  constructor(body) {
    this.nodes = body.nodes;
    this.beams = body.beams;
    this.count = body.amplitudes.length;
    this.names = body.amplitudes;
    this.nodeNames = body.names ?? [];
    this.gauges = body.gauges ?? [];
    this.start = body.start ?? body.amplitudes.map(() => 0);
    this.modes = floats(body.modes);
    this.displaced = body.nodes.map((node) => [...node]);
    this.stress = null;
    this.unit = body.stress?.unit ?? "Pa";
    /** Stress of the last colour in the scene; 0: the largest stress so far. */
    this.range = body.stress?.range ?? 0;
    this.limit = body.stress?.limit ?? null;
    this.limitName = body.stress?.limit_name ?? "limit";
    /** Column that is 0 while this body is rigid in the model. */
    this.computed = body.computed;
    if (body.stress !== undefined) {
      this.round = body.stress.rule === "round";
      this.fibres = this.round ? 3 : body.stress.fibres;
      this.rows = floats(body.stress.rows);
      this.constant = body.stress.constant === undefined ? null : floats(body.stress.constant);
      /** Largest absolute stress at both ends of each beam. */
      this.stress = new Float64Array(2 * this.beams.length);
    }
    checkLength("modes", this.modes, 3 * this.nodes.length * this.count);
    if (this.stress !== null) checkLength("stress.rows", this.rows, 2 * this.beams.length * this.fibres * this.count);
  }

  /**
   * @param {((name: string) => number | undefined) | null} lookup
   * @param {number} factor of the displacement
   * @returns {string | null} the column without a number; null if nothing is computed; else empty. In the first two
   *   cases the body is undeformed
   */
  update(lookup, factor) {
    const computed = lookup === null || this.computed === undefined ? 1 : lookup(this.computed);
    if (!(Math.abs(computed) > 0)) {
      this._displace(this.names.map(() => 0), factor);
      return computed === 0 ? null : this.computed;
    }
    const amplitudes = this.names.map((name, i) => (lookup === null ? this.start[i] : lookup(name)));
    const absent = this.names.find((_, i) => !Number.isFinite(amplitudes[i]));
    const now = absent === undefined ? amplitudes : amplitudes.map(() => 0);
    this._displace(now, factor);
    if (this.stress !== null && absent === undefined) this._stress(now);
    return absent ?? "";
  }

  /** Largest displacement of a node with the factor, m. */
  largestMove() {
    return this.nodes.reduce((most, node, i) => Math.max(most, Math.hypot(...node.map((x, k) => this.displaced[i][k] - x))), 0);
  }

  _displace(amplitudes, factor) {
    const { modes, count } = this;
    this.nodes.forEach((node, i) => {
      for (let k = 0; k < 3; k++) {
        let sum = 0;
        for (let m = 0; m < count; m++) sum += modes[(3 * i + k) * count + m] * amplitudes[m];
        this.displaced[i][k] = node[k] + factor * sum;
      }
    });
  }

  _stress(amplitudes) {
    const { rows, fibres, count, constant } = this;
    const at = new Array(fibres).fill(0);
    for (let end = 0; end < this.stress.length; end++) {
      for (let f = 0; f < fibres; f++) {
        const row = end * fibres + f;
        let sum = constant === null ? 0 : constant[row];
        for (let m = 0; m < count; m++) sum += rows[row * count + m] * amplitudes[m];
        at[f] = sum;
      }
      // In a round tube axial stress and resultant bending stress add at one fibre.
      this.stress[end] = this.round ? Math.abs(at[0]) + Math.hypot(at[1], at[2]) : Math.max(...at.map(Math.abs));
    }
  }
}

function checkLength(name, array, size) {
  if (array.length !== size) throw new Error(`${name} of a flexible body has ${array.length} numbers, not ${size}.`);
}
