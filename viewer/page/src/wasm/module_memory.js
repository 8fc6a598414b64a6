// The memory of a WebAssembly module: blocks, texts and numbers in it. Addresses and sizes are 32-bit numbers.

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** Blocks, texts and numbers in the memory of a module that exports `memory`, `malloc` and `free`. */
export class ModuleMemory {
  /** @param {Data} exports of the module */
  constructor(exports) {
    this.exports = exports;
    this.view();
  }

  /** Views of the whole memory; made again after it has grown, which detaches the old ones. */
  view() {
    const { buffer } = this.exports.memory;
    if (this.buffer !== buffer) {
      this.buffer = buffer;
      this.bytes = new Uint8Array(buffer);
      this.words = new Uint32Array(buffer);
      this.integers = new Int32Array(buffer);
      this.doubles = new Float64Array(buffer);
    }
    return this;
  }

  /** Allocates a block, aligned for all numbers. @param {number} size bytes @returns {number} its address */
  block(size) {
    const address = this.exports.malloc(Math.max(size, 1)) >>> 0;
    if (address === 0) throw new Error(`There is not enough memory for ${size} bytes in the FMU's module.`);
    return address;
  }

  /** Frees a block. @param {number} address 0: no block */
  free(address) {
    if (address !== 0) this.exports.free(address);
  }

  /** Allocates a block with a copy of bytes. @param {Uint8Array} bytes @returns {number} its address */
  blockOf(bytes) {
    const address = this.block(bytes.length);
    this.view().bytes.set(bytes, address);
    return address;
  }

  /**
   * Calls `work` with blocks for texts, each ended by a zero, and frees them afterwards.
   * @param {string[]} texts
   * @param {(...addresses: number[]) => T} work takes their addresses
   * @returns {T} what `work` returns
   * @template T
   */
  withTexts(texts, work) {
    const blocks = [];
    try {
      for (const text of texts) blocks.push(this.blockOf(encoder.encode(`${text}\0`)));
      return work(...blocks);
    } finally {
      for (const block of blocks) this.free(block);
    }
  }

  /** The text at an address. @param {number} address of a text that ends with a zero @returns {string} */
  text(address) {
    const { bytes } = this.view();
    return decoder.decode(bytes.subarray(address, bytes.indexOf(0, address)));
  }
}
