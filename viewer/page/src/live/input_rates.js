// Rate-limited inputs: each approaches its requested value at a limited rate in simulated time.

/** The values of inputs, step by step. */
export class LimitedInputs {
  /** @param {number[]} start - A value for each input. */
  constructor(start) {
    this.values = Float64Array.from(start);
    this.wanted = Float64Array.from(start);
    this._rates = new Float64Array(start.length).fill(Infinity);
  }

  /**
   * @param {number} index - Of the input.
   * @param {number} value - Wanted.
   * @param {number} [rate] - Largest change per second; infinite: at once.
   */
  want(index, value, rate = Infinity) {
    this.wanted[index] = value;
    this._rates[index] = rate;
  }

  /** The values hold as they are, as after a rewind. */
  hold(values) {
    this.values.set(values);
  }

  /**
   * Move on.
   * @param {number} step - s.
   * @returns {Float64Array} The values for this step.
   */
  move(step) {
    for (let i = 0; i < this.values.length; i++) {
      const most = this._rates[i] * step;
      const gap = this.wanted[i] - this.values[i];
      this.values[i] = Math.abs(gap) <= most ? this.wanted[i] : this.values[i] + Math.sign(gap) * most;
    }
    return this.values;
  }
}
