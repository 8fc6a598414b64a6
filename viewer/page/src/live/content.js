// Decodes the content of the page of an FMU: FMUs with their drawings and roads, recordings beside them, a table of inputs.
import { decodePage } from "../sources/decode.js";
import { Sampler } from "../sources/sampler.js";
import { unpack, unpackJson } from "../bytes.js";

/**
 * @param {Data[]} parts FMUs with compressed scenes, modules and resources
 * @param {{beside?: Data, ends: string[], script?: string}} more see `Drive`
 * @returns {Promise<{fmus: Data[], drawings: Data[], recordings: Data[], table: Data | null}>} `drawings`: of the FMUs.
 */
export async function decodeContent(parts, { beside, ends, script }) {
  const runs = beside ? (await decodePage(beside)).runs : [];
  const recordings = runs.map((run, k) => {
    const sampler = new Sampler(run);
    return { title: `${run.name} (recorded)`, scene: run.scene, sample: (time) => sampler.at(time), recording: { ...run, end: ends[k] } };
  });
  const fmus = [];
  for (const part of parts) fmus.push(await decodeFmu(part));
  const drawings = [];
  for (const fmu of fmus) drawings.push(await decodeDrawing(fmu));
  return { fmus, drawings, recordings, table: script ? await unpackJson(script) : null };
}

/** An FMU with its scene, module and resources. @param {Data} part */
async function decodeFmu(part) {
  const resources = {};
  for (const [path, compressed] of Object.entries(part.resources ?? {})) resources[path] = await unpack(compressed);
  return { ...part, scene: await unpackJson(part.scene), wasm: await unpack(part.wasm), resources };
}

/** The drawing of an FMU on the road of its world. @param {Data} fmu */
async function decodeDrawing({ title, scene, roads: packedRoads, world: packedWorld, description }) {
  const roads = packedRoads ? await unpackJson(packedRoads) : {};
  const world = packedWorld ? await unpackJson(packedWorld) : null;
  const drawn = world ? { ...scene, roads: roads[world.road], scenery: world.scenery } : scene;
  return { title, scene: drawn, roads, world, variables: new Map(description.variables.map((v) => [v.name, v])) };
}
