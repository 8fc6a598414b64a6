// An instance of an FMU: life cycle, values, steps and states.
import { FmuError, STATUSES } from "./errors.js";
import { Transfer } from "./transfer.js";

const MAX_MESSAGES = 1000;
const LAST_SUCCESSFUL_TIME = 2;

/** A state of an instance, kept in the module's memory. */
class FmuState {
  constructor(instance) {
    this.instance = instance;
    this.address = 0;
    this.phase = undefined; // phase of the instance, if known
  }

  /** Frees its memory. */
  free() {
    if (this.address === 0) return;
    this.instance._withPointer(this.address, (p, c, e) => e.fmi2FreeFMUstate(c, p), "Freeing a state");
    this.instance._owned.delete(this);
    this.address = 0;
  }
}

/** An instance, made by `Fmu.instantiate`. A refused call throws an `FmuError`; the instance remains usable. */
export class FmuInstance {
  constructor(fmu, component, messages) {
    this.fmu = fmu;
    this._component = component;
    this._scratch = fmu.memory.block(16); // block for one value reference or pointer, and one value
    this._owned = new Set(); // states and transfers, freed with the instance
    this._phase = "new";
    this._startTime = 0;
    this._started = false;
    /** Communication point, s. */
    this.time = 0;
    /** Messages of the FMU, the last 1000: status (a word), category, text. */
    this.messages = [];
    this._addMessages(messages);
  }

  /**
   * Sets variables, each by its type.
   * @param {string|Object<string, number|boolean|string>} name a name, or values by name
   * @param {number|boolean|string} [value]
   */
  set(name, value) {
    if (typeof name !== "string") {
      for (const [each, entry] of Object.entries(name)) this.set(each, entry);
      return;
    }
    this[`set${this._variable(name).type}`](name, value);
  }

  /** @param {string} name @param {number} value */
  setReal(name, value) {
    this._setNumber("fmi2SetReal", "Real", name, value, (memory, at) => (memory.doubles[at >>> 3] = value));
  }

  /** @param {string} name @param {number} value a whole number */
  setInteger(name, value) {
    if (!Number.isInteger(value)) throw new FmuError(`'${name}' is a whole number; it cannot be ${value}.`, "error");
    this._setNumber("fmi2SetInteger", "Integer", name, value, (memory, at) => (memory.integers[at >>> 2] = value));
  }

  /** @param {string} name @param {boolean} value */
  setBoolean(name, value) {
    const number = value ? 1 : 0;
    this._setNumber("fmi2SetBoolean", "Boolean", name, value, (memory, at) => (memory.integers[at >>> 2] = number));
  }

  /** @param {string} name @param {string} value */
  setString(name, value) {
    const { memory } = this.fmu;
    memory.withTexts([String(value)], (text) =>
      this._setNumber("fmi2SetString", "String", name, `'${value}'`, (view, at) => (view.words[at >>> 2] = text)),
    );
  }

  /** @param {string} name of a text variable @returns {string} */
  getString(name) {
    const { memory, exports } = this.fmu;
    memory.view().words[this._scratch >>> 2] = this._variable(name, "String").reference;
    this._call(`Reading '${name}'`, () => exports.fmi2GetString(this._component, this._scratch, 1, this._scratch + 8));
    return memory.text(memory.view().words[(this._scratch + 8) >>> 2]);
  }

  /**
   * Values of variables of the types Real and Integer.
   * @param {string[]} names
   * @returns {Float64Array} one value a name
   */
  get(names) {
    const reader = new Transfer(this, names);
    try {
      return reader.read().slice();
    } finally {
      reader.free();
    }
  }

  /**
   * A function that reads variables of the types Real and Integer, prepared for many calls.
   * @param {string[]} names
   * @returns {() => Float64Array} returns one value a name, in an array that the next call fills again
   */
  reader(names) {
    const transfer = new Transfer(this, names);
    this._owned.add(transfer);
    return () => transfer.read();
  }

  /**
   * A function that sets variables of the types Real and Integer, prepared for many calls.
   * @param {string[]} names
   * @returns {(values: ArrayLike<number>) => void} takes one value a name
   */
  writer(names) {
    const transfer = new Transfer(this, names);
    this._owned.add(transfer);
    return (values) => transfer.write(values);
  }

  /**
   * Initialises. May be called again after it was refused and other values were set.
   * @param {object} [experiment]
   * @param {number} [experiment.startTime] s
   * @param {number} [experiment.stopTime] s; without it the run has no end
   */
  initialise({ startTime = 0, stopTime } = {}) {
    const { exports } = this.fmu;
    const c = this._component;
    if (this._phase === "new") {
      const bounded = stopTime === undefined ? 0 : 1;
      this._call("Setting the experiment up", () =>
        exports.fmi2SetupExperiment(c, 0, 0, startTime, bounded, bounded ? stopTime : 0),
      );
      this._call("Entering initialisation", () => exports.fmi2EnterInitializationMode(c));
      this._phase = "initialising";
      this._startTime = startTime;
    } else if (this._phase === "initialising" && startTime !== this._startTime) {
      throw new FmuError(`The start time is ${this._startTime} s already; another one needs reset().`, "error");
    }
    this._call("Initialising", () => exports.fmi2ExitInitializationMode(c));
    this._phase = "running";
    this.time = startTime;
  }

  /**
   * A communication step. A refused one leaves time and state as they were.
   * @param {number} h s
   * @returns {string} "ok" or "warning"
   */
  step(h) {
    const { exports } = this.fmu;
    const status = this._call(`The step from ${this.time} s over ${h} s`, () =>
      exports.fmi2DoStep(this._component, this.time, h, 1),
    );
    this.time = this._kernelTime();
    return STATUSES[status];
  }

  /**
   * Saves the state; `setState` restores it.
   * @param {FmuState} [state] an older state, whose memory is used again
   * @returns {FmuState} valid until its `free()` is called
   */
  getState(state = new FmuState(this)) {
    state.address = this._withPointer(state.address, (p, c, e) => e.fmi2GetFMUstate(c, p), "Getting the state");
    state.phase = this._phase;
    this._owned.add(state);
    return state;
  }

  /** Restores a state. @param {FmuState} state from `getState` or `deserialise` */
  setState(state) {
    this._call("Setting the state", () => this.fmu.exports.fmi2SetFMUstate(this._component, state.address));
    this.time = this._kernelTime();
    this._phase = state.phase ?? (this._started ? "running" : "new");
  }

  /** A state as bytes, the same on every platform. @param {FmuState} state @returns {Uint8Array} */
  serialise(state) {
    const what = "Serialising a state";
    const { memory } = this.fmu;
    const size = this._withPointer(0, (p, c, e) => e.fmi2SerializedFMUstateSize(c, state.address, p), what);
    const block = memory.block(size);
    try {
      this._call(what, () => this.fmu.exports.fmi2SerializeFMUstate(this._component, state.address, block, size));
      return memory.view().bytes.slice(block, block + size);
    } finally {
      memory.free(block);
    }
  }

  /**
   * A state from bytes; `setState` restores it.
   * @param {Uint8Array} bytes result of `serialise`, here or on another platform
   * @returns {FmuState}
   */
  deserialise(bytes) {
    const { memory } = this.fmu;
    const state = new FmuState(this);
    const block = memory.blockOf(bytes);
    const work = (p, c, e) => e.fmi2DeSerializeFMUstate(c, block, bytes.length, p);
    try {
      state.address = this._withPointer(0, work, "Reading a state");
      this._owned.add(state);
      return state;
    } finally {
      memory.free(block);
    }
  }

  /** Returns to the condition after `instantiate`; values that were set are lost, saved states remain. */
  reset() {
    this._call("Resetting", () => this.fmu.exports.fmi2Reset(this._component));
    this._phase = "new";
    this.time = 0;
  }

  /** Ends the run; values can still be read. */
  terminate() {
    this._call("Ending the run", () => this.fmu.exports.fmi2Terminate(this._component));
  }

  /** Frees the instance and its states; they cannot be used afterwards. */
  free() {
    if (this._component === 0) return;
    for (const each of [...this._owned]) each.free();
    this.fmu.call(() => this.fmu.exports.fmi2FreeInstance(this._component));
    this.fmu.memory.free(this._scratch);
    this._component = 0;
  }

  _variable(name, type) {
    const variable = this.fmu.variables.get(name);
    if (variable === undefined) {
      throw new FmuError(`The FMU ${this.fmu.description.modelName} has no variable '${name}'.`, "error");
    }
    if (type !== undefined && variable.type !== type) {
      throw new FmuError(`'${name}' is of the type ${variable.type}, not ${type}.`, "error");
    }
    return variable;
  }

  _setNumber(call, type, name, value, put) {
    const { memory, exports } = this.fmu;
    const { reference } = this._variable(name, type);
    memory.view().words[this._scratch >>> 2] = reference;
    put(memory, this._scratch + 8);
    this._call(`Setting '${name}' to ${value}`, () => exports[call](this._component, this._scratch, 1, this._scratch + 8));
  }

  /** Makes a call with the address of a 32-bit number, which is `value` before it; returns the number after it. */
  _withPointer(value, work, what) {
    const { memory, exports } = this.fmu;
    memory.view().words[this._scratch >>> 2] = value;
    this._call(what, () => work(this._scratch, this._component, exports));
    return memory.view().words[this._scratch >>> 2];
  }

  /** The communication point of the FMU, s; the start time before the end of initialisation. */
  _kernelTime() {
    const { memory, exports } = this.fmu;
    const ask = () => exports.fmi2GetRealStatus(this._component, LAST_SUCCESSFUL_TIME, this._scratch);
    this._started = this.fmu.call(ask) === 0;
    if (this._started) return memory.view().doubles[this._scratch >>> 3];
    this.fmu.takeMessages(); // discard the message about it
    return this._startTime;
  }

  /** Makes a call; throws the FMU's explanation if it is refused. */
  _call(what, work) {
    if (this._component === 0) throw new FmuError("This instance was freed.", "error");
    const status = this.fmu.call(work);
    const messages = this.fmu.takeMessages();
    if (messages.length > 0) this._addMessages(messages);
    if (status < 2) return status;
    const words = messages.filter((m) => m.status >= 2).map((m) => m.text);
    throw new FmuError(`${what} was refused: ${words.join(" ") || "the FMU says no more."}`, STATUSES[status]);
  }

  _addMessages(messages) {
    for (const { status, category, text } of messages) this.messages.push({ status: STATUSES[status], category, text });
    if (this.messages.length > MAX_MESSAGES) this.messages.splice(0, this.messages.length - MAX_MESSAGES);
  }
}
