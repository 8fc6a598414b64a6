// From the JSON of a page to runs with arrays.
import { bytesOf, gunzipped, missingParts } from "../bytes.js";

/**
 * @typedef {{scene: Data | null, t: Float64Array, epoch: ArrayLike<number>, columns: Object<string, {unit: string, data: ArrayLike<number>}>,
 *   name: string, notes: string[], missing: {name: string, why: string}[]}} Run
 */

/**
 * Numbers whose bytes stand in planes: all first bytes, then all second ones.
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

/** @param {{names: string[], kind: "f8" | "f4", data: string}} block @returns {Promise<Map<string, ArrayLike<number>>>} */
async function columnsOf(block) {
  const numbers = fromPlanes(await gunzipped(bytesOf(block.data)), block.kind);
  const count = numbers.length / block.names.length;
  return new Map(block.names.map((name, k) => [name, numbers.subarray(k * count, (k + 1) * count)]));
}

/**
 * @param {Data} page JSON that viewer/page_data.py makes
 * @returns {Promise<{runs: Run[], options: Data}>}
 */
export async function decoded(page) {
  if (page.format !== "ALi3 page" || page.version !== 1) throw new Error("The data of this page are of another format.");
  const lacking = missingParts(globalThis, false);
  if (lacking) throw new Error(lacking);
  const runs = await Promise.all(
    page.runs.map(async (run) => {
      const times = await columnsOf(run.time);
      const found = new Map();
      for (const block of run.blocks) for (const [name, data] of await columnsOf(block)) found.set(name, data);
      const columns = Object.create(null);
      for (const name of run.order) columns[name] = { unit: run.units[name] ?? "", data: found.get(name) };
      const scene = run.scene === null ? null : page.scenes[run.scene];
      return { scene, t: times.get("time"), epoch: times.get("epoch"), columns, name: run.name, notes: run.notes, missing: run.missing };
    }),
  );
  return { runs, options: page.options };
}
