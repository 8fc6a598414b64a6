// Decodes the JSON of a page into runs with arrays.
import { decodeBase64, decompress } from "../bytes.js";
import { missingParts } from "../common/browser_support.js";

/**
 * @typedef {{scene: Data | null, t: Float64Array, epoch: ArrayLike<number>, columns: Object<string, {unit: string, data: ArrayLike<number>}>,
 *   name: string, notes: string[], missing: {name: string, why: string}[], constants?: Object<string, number>}} Run
 */

/**
 * Numbers from bytes in planes: the first bytes of all numbers, then their second bytes, and so on.
 * @param {Uint8Array} planes
 * @param {"f8" | "f4"} kind
 * @returns {Float64Array | Float32Array}
 */
export function fromPlanes(planes, kind) {
  const size = kind === "f8" ? 8 : 4;
  const count = planes.length / size;
  const bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < size; plane++) {
    for (let i = 0, from = plane * count, to = plane; i < count; i++, to += size) bytes[to] = planes[from + i];
  }
  return kind === "f8" ? new Float64Array(bytes.buffer) : new Float32Array(bytes.buffer);
}

/** Columns of a block, by name. @param {{names: string[], kind: "f8" | "f4", data: string}} block @returns {Promise<Map<string, ArrayLike<number>>>} */
async function columnsOf(block) {
  const numbers = fromPlanes(await decompress(decodeBase64(block.data)), block.kind);
  const count = numbers.length / block.names.length;
  return new Map(block.names.map((name, k) => [name, numbers.subarray(k * count, (k + 1) * count)]));
}

/** A run from its JSON. @param {Data} run @param {Data[]} scenes of the page @returns {Promise<Run>} */
async function decodeRun({ scene, time, blocks, order, units, name, notes, missing, constants }, scenes) {
  const [times, ...parts] = await Promise.all([time, ...blocks].map(columnsOf));
  const arrays = new Map(parts.flatMap((part) => [...part]));
  const columns = Object.create(null);
  for (const column of order) columns[column] = { unit: units[column] ?? "", data: arrays.get(column) };
  return { scene: scene === null ? null : scenes[scene], t: /** @type {Float64Array} */ (times.get("time")), epoch: times.get("epoch"), columns, name, notes, missing, constants };
}

/**
 * Runs and options of a page.
 * @param {Data} page JSON made by viewer/page_data.py
 * @returns {Promise<{runs: Run[], options: Data}>}
 */
export async function decodePage(page) {
  if (page.format !== "ALi3 page" || page.version !== 1) throw new Error("The data of this page are of another format.");
  const problem = missingParts(globalThis, false);
  if (problem) throw new Error(problem);
  return { runs: await Promise.all(page.runs.map((run) => decodeRun(run, page.scenes))), options: page.options };
}
