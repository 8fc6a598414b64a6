// The record of a run with a row for each communication step, for plots, interpolated pictures, and a table.

const ROWS = 1024; // in a block

/** Rows of numbers at the times k * step; row k has the inputs of the step that begins there. */
export class Record {
  /**
   * @param {string[]} inputs names of inputs and tunable parameters
   * @param {string[]} outputs names of the outputs of all instances
   * @param {number} step s
   * @param {number} [most] largest size, bytes; beyond it the oldest rows are removed
   */
  constructor(inputs, outputs, step, most = 4e8) {
    this.held = inputs;
    this.outputs = outputs;
    this.step = step;
    this.width = inputs.length + outputs.length;
    this._blocksMost = Math.max(2, Math.floor(most / (8 * ROWS * this.width)));
    this._blocks = [];
    this.first = 0;
    this.end = 0; // index after the last row
  }

  /** Time of the last row, s. */
  get time() {
    return Math.max(0, this.end - 1) * this.step;
  }

  /**
   * Appends a row.
   * @param {ArrayLike<number>} inputs values during the step that ends there, which belong to the previous row
   * @param {ArrayLike<number>} outputs at its end
   */
  add(inputs, outputs) {
    if (this.end > this.first) this._row(this.end - 1).set(inputs, 0);
    if (this.end % ROWS === 0 || !this._blocks.length) this._grow();
    this.end += 1;
    const row = this._row(this.end - 1);
    row.set(inputs, 0); // preliminary, until the next step
    row.set(outputs, this.held.length);
  }

  /** Removes the rows after k. */
  cut(k) {
    this.end = Math.max(this.first, Math.min(this.end, k + 1));
    const keep = this.end === 0 ? 0 : Math.floor((this.end - 1) / ROWS) - this._base + 1;
    this._blocks.length = Math.min(this._blocks.length, keep);
  }

  /** Values of row k: inputs and parameters, then outputs. */
  row(k) {
    return this._row(Math.max(this.first, Math.min(this.end - 1, k)));
  }

  /** Index of a column in a row; -1 if there is none. */
  column(name) {
    const column = this.held.indexOf(name);
    if (column >= 0) return column;
    const output = this.outputs.indexOf(name);
    return output < 0 ? -1 : this.held.length + output;
  }

  /**
   * Every `stride`th value of a column, and the last one.
   * @param {number} index of the column
   * @param {number} from first row
   * @param {number} stride
   * @returns {[number[], number[]]} times and values
   */
  series(index, from, stride) {
    const t = [];
    const values = [];
    const begin = Math.ceil(Math.max(from, this.first) / stride) * stride;
    const add = (k) => {
      t.push(k * this.step);
      values.push(this._row(k)[index]);
    };
    for (let k = begin; k < this.end - 1; k += stride) add(k);
    if (this.end > this.first) add(this.end - 1);
    return [t, values];
  }

  /**
   * The run as a table that `ali3 run --manoeuvre` and `ali3 view` read.
   * @param {string[]} comments lines after the numbers, for programs that do not support comments
   * @param {string[]} [kept] names of columns of inputs and parameters; by default all
   * @param {string[]} [outputs] names of columns of outputs; by default all
   * @returns {string[]} parts of the text
   */
  csv(comments, kept = this.held, outputs = this.outputs) {
    const columns = [...kept, ...outputs].map((name) => this.column(name));
    const names = ["time", ...kept, ...outputs];
    const parts = [`${names.map((name) => `"${name}"`).join(",")}\n`];
    for (let begin = this.first; begin < this.end; begin += ROWS) {
      let text = "";
      for (let k = begin; k < Math.min(begin + ROWS, this.end); k++) {
        const row = this._row(k);
        text += `${k * this.step}`;
        for (const column of columns) text += `,${Object.is(row[column], -0) ? "-0" : row[column]}`;
        text += "\n";
      }
      parts.push(text);
    }
    parts.push(comments.map((line) => `# ${line}\n`).join(""));
    return parts;
  }

  get _base() {
    return Math.floor(this.first / ROWS);
  }

  _row(k) {
    const block = this._blocks[Math.floor(k / ROWS) - this._base];
    const begin = (k % ROWS) * this.width;
    return block.subarray(begin, begin + this.width);
  }

  _grow() {
    this._blocks.push(new Float64Array(ROWS * this.width));
    if (this._blocks.length > this._blocksMost) {
      this._blocks.shift();
      this.first = (this._base + 1) * ROWS;
    }
  }
}

/**
 * Interpolated values between two rows.
 * @param {Record} record
 * @param {number} time s
 * @param {import("../sources/blend.js").Blend} blend
 * @param {Map<string, number>} columns index in a row by name
 * @returns {(name: string) => number | undefined}
 */
export function between(record, time, blend, columns) {
  const x = Math.max(record.first, Math.min(record.end - 1, time / record.step));
  const k = Math.min(Math.floor(x), Math.max(record.first, record.end - 2));
  const numbers = (/** @type {ArrayLike<number>} */ row) => (name) => row[columns.get(name)];
  return blend.lookup(numbers(record.row(k)), numbers(record.row(k + 1)), x - k);
}
