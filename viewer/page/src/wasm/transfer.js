// Transfers many values at once between an instance and an array, through a reserved block of the module's memory.
import { FmuError } from "./errors.js";

/** Values of fixed variables of the types Real and Integer; one call of the FMU for each type. */
export class Transfer {
  /** @param {import("./instance.js").FmuInstance} instance @param {string[]} names */
  constructor(instance, names) {
    this.instance = instance;
    this.names = names;
    this.values = new Float64Array(names.length);
    const variables = names.map((name) => instance._variable(name));
    const other = variables.find(({ type }) => type !== "Real" && type !== "Integer");
    if (other !== undefined) {
      throw new FmuError(`'${other.name}' is of the type ${other.type}; numbers are Real or Integer.`, "error");
    }
    this.groups = ["Real", "Integer"].map((type) => this._group(type, variables)).filter((group) => group.n > 0);
  }

  _group(type, variables) {
    const { memory } = this.instance.fmu;
    const places = variables.flatMap((variable, k) => (variable.type === type ? [k] : []));
    const n = places.length;
    const whole = n === variables.length; // all values are of this type, in the order of the names
    const block = n > 0 ? memory.block(16 * n) : 0; // values, then references
    const { words } = memory.view();
    places.forEach((place, k) => (words[((block + 8 * n) >>> 2) + k] = variables[place].reference));
    return { type, places, n, whole, block, references: block + 8 * n };
  }

  /** Reads all values. @returns {Float64Array} an array that the next call fills again */
  read() {
    const { instance, values } = this;
    const { fmu, _component: component } = instance;
    for (const { type, places, n, whole, block, references } of this.groups) {
      const call = type === "Real" ? fmu.exports.fmi2GetReal : fmu.exports.fmi2GetInteger;
      instance._call("Reading values", () => call(component, references, n, block));
      const memory = fmu.memory.view();
      if (type === "Real" && whole) {
        values.set(memory.doubles.subarray(block >>> 3, (block >>> 3) + n));
      } else if (type === "Real") {
        for (let k = 0; k < n; k++) values[places[k]] = memory.doubles[(block >>> 3) + k];
      } else {
        for (let k = 0; k < n; k++) values[places[k]] = memory.integers[(block >>> 2) + k];
      }
    }
    return values;
  }

  /** Writes all values. @param {ArrayLike<number>} given one value a name */
  write(given) {
    const { instance, values } = this;
    const { fmu, _component: component } = instance;
    if (given.length !== values.length) {
      throw new FmuError(`${given.length} values were given for ${values.length} variables.`, "error");
    }
    const integers = this.groups.find(({ type }) => type === "Integer")?.places ?? [];
    const wrong = integers.find((place) => !Number.isInteger(given[place]));
    if (wrong !== undefined) {
      throw new FmuError(`'${this.names[wrong]}' is a whole number; it cannot be ${given[wrong]}.`, "error");
    }
    for (const { type, places, n, block, references } of this.groups) {
      const memory = fmu.memory.view();
      const to = type === "Real" ? memory.doubles : memory.integers;
      const first = type === "Real" ? block >>> 3 : block >>> 2;
      for (let k = 0; k < n; k++) to[first + k] = given[places[k]];
      const call = type === "Real" ? fmu.exports.fmi2SetReal : fmu.exports.fmi2SetInteger;
      instance._call("Setting values", () => call(component, references, n, block));
    }
  }

  /** Frees its memory. */
  free() {
    for (const { block } of this.groups) this.instance.fmu.memory.free(block);
    this.groups = [];
  }
}
