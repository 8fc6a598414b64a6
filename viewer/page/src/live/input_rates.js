// Rate-limited inputs, which approach requested values at limited rates in simulated time.

/** Values of inputs in each step. */
export class LimitedInputs {
  /** @param {number[]} start a value for each input */
  constructor(start) {
    this.values = Float64Array.from(start);
    this.wanted = Float64Array.from(start);
    this._rates = new Float64Array(start.length).fill(Infinity);
  }

  /**
   * @param {number} index of the input
   * @param {number} value requested value
   * @param {number} [rate] largest change per second; infinite: immediate
   */
  want(index, value, rate = Infinity) {
    this.wanted[index] = value;
    this._rates[index] = rate;
  }

  /** Sets the values, as after a rewind. */
  hold(values) {
    this.values.set(values);
  }

  /** Advances by a step. @param {number} step s @returns {Float64Array} the values for this step */
  move(step) {
    for (let i = 0; i < this.values.length; i++) {
      const most = this._rates[i] * step;
      const gap = this.wanted[i] - this.values[i];
      this.values[i] = Math.abs(gap) <= most ? this.wanted[i] : this.values[i] + Math.sign(gap) * most;
    }
    return this.values;
  }
}
