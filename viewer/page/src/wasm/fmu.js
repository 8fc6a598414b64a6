// An FMU of ALi3 (FMI 2.0, platform wasm32) in a page or any other JavaScript host.
import { describe } from "./description.js";
import { FmuError } from "./errors.js";
import { FmuInstance } from "./instance.js";
import { ModuleMemory } from "./module_memory.js";

export { FmuError };

const RESOURCES = "/resources";

/**
 * Loads an FMU.
 * @param {object} parts
 * @param {BufferSource} parts.wasm the file binaries/wasm32/NAME.wasm
 * @param {string|import("./description.js").Description} parts.description text of modelDescription.xml, or its content as an object
 * @param {Object<string, ArrayBuffer|Uint8Array>} parts.resources files by their paths inside the folder resources
 * @returns {Promise<Fmu>}
 */
export async function loadFmu({ wasm, description, resources = {} }) {
  const described = describe(description);
  /** @type {WebAssembly.Instance} */
  let instance;
  try {
    ({ instance } = await WebAssembly.instantiate(wasm, {}));
  } catch (error) {
    throw new Error(`The binary of the FMU ${described.modelName} for wasm32 cannot be loaded: ${error.message}`, { cause: error });
  }
  const exports = /** @type {Data} */ (instance.exports);
  const missing = ["memory", "malloc", "free", "fmi2DoStep", "ali3_file_add", "ali3_callbacks", "ali3_messages"].find(
    (name) => exports[name] === undefined,
  );
  if (missing !== undefined) {
    throw new Error(`The file is no binary for wasm32 of an FMU of ALi3: it exports no ${missing}.`);
  }
  exports._initialize?.();
  const fmu = new Fmu(exports, described);
  for (const [path, bytes] of Object.entries(resources)) fmu.addFile(path, bytes);
  return fmu;
}

/** A loaded FMU; its instances share one memory. */
export class Fmu {
  /** @param {Data} exports of the module @param {import("./description.js").Description} description */
  constructor(exports, description) {
    this.exports = exports;
    this.description = description;
    this.memory = new ModuleMemory(exports);
    /** @type {Map<string, import("./description.js").Variable>} variables by name */
    this.variables = new Map(description.variables.map((variable) => [variable.name, variable]));
    /** Why the module can no longer be used; empty while it can. */
    this.broken = "";
    this._box = exports.ali3_messages() >>> 2;
  }

  /**
   * Puts a file into the folder of the resources, in place of one with the same path. Roads are in roads/.
   * @param {string} path such as "system_0.ali3" or "roads/own.road"
   * @param {ArrayBuffer|Uint8Array} content
   */
  addFile(path, content) {
    const { memory } = this;
    const block = memory.blockOf(content instanceof Uint8Array ? content : new Uint8Array(content));
    const added = memory.withTexts([`${RESOURCES}/${path}`], (text) =>
      this.exports.ali3_file_add(text, block, content.byteLength),
    );
    if (!added) {
      memory.free(block);
      throw new Error(`The file '${path}' cannot be put into the FMU: its path is too long, or memory is short.`);
    }
  }

  /**
   * Makes an instance.
   * @param {object} [options]
   * @param {string} [options.name]
   * @param {boolean} [options.logging] whether it reports more than problems
   * @returns {FmuInstance}
   */
  instantiate({ name = this.description.modelName, logging = false } = {}) {
    const { memory, exports } = this;
    const component = memory.withTexts([name, this.description.guid, `file://${RESOURCES}`], (n, guid, folder) =>
      this.call(() => exports.fmi2Instantiate(n, 1, guid, folder, exports.ali3_callbacks(), 0, logging ? 1 : 0)),
    );
    const messages = this.takeMessages();
    if (component === 0) {
      throw new FmuError(`The FMU gave no instance: ${messages.map((m) => m.text).join(" ")}`, "error");
    }
    return new FmuInstance(this, component >>> 0, messages);
  }

  /**
   * Calls a function of the module. After a trap its memory cannot be trusted: all later calls are refused.
   * @param {() => number} work
   * @returns {number} what `work` returns
   */
  call(work) {
    if (this.broken) throw new FmuError(this.broken, "fatal");
    try {
      return work();
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError || error instanceof RangeError)) throw error;
      const { modelName } = this.description;
      this.broken = `The FMU ${modelName} stopped working (${error.message}); it must be loaded again.`;
      throw new FmuError(this.broken, "fatal");
    }
  }

  /** Messages since the last call, oldest first. @returns {{status: number, category: string, text: string}[]} */
  takeMessages() {
    const { memory, _box: box } = this;
    const { words } = memory.view();
    const used = words[box];
    if (used === 0) return [];
    const lost = words[box + 1];
    const parts = new TextDecoder().decode(memory.bytes.subarray(4 * box + 8, 4 * box + 8 + used)).split("\0");
    words[box] = words[box + 1] = 0;
    const messages = [];
    for (let k = 0; k + 1 < parts.length; k += 2) {
      messages.push({ status: Number(parts[k][0]), category: parts[k].slice(1), text: parts[k + 1] });
    }
    if (lost > 0) {
      messages.push({ status: 1, category: "logStatusWarning", text: `${lost} more messages found no room.` });
    }
    return messages;
  }
}
