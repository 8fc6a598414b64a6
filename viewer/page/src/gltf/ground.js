// Meshes of roads, terrain and paths near the path of the run.
import * as THREE from "three";
import looks from "../../../looks.json" with { type: "json" };
import { ribbonEdges, ribbonTriangles } from "../effects/path.js";
import { HeightField, SurfaceRaster, gripOf, nearest, slickName } from "../looks/heights.js";
import { LIFT } from "../looks/ground_offset.js";
import { groundAxes, makeRoads } from "../looks/roads.js";
import { errorOf, strided } from "../looks/terrain_mesh.js";
import { groundPaths } from "../player/traces.js";
import { floats } from "../bytes.js";
import { add, length, scale, subtract } from "../scene/math.js";

/** Width of the drawn ground beside the path, m. */
export const MARGIN = 60;
/** Largest number of cells of a ground, and their least side, m. */
const [MAX_CELLS, MIN_CELL] = [60000, 0.25];
/** Height of paths above the ground, m, which covers errors of the thinned ground and of the contact points. */
const PATH_HEIGHT = 0.05;
/** Distance of points of a path, as a share of the size of the scene. */
const POINT_DISTANCE = 0.02;

const { body: BODY, wheel: WHEEL, shares: SHARES, opacities: OPACITIES } = looks.paths;

/** @type {Map<string, THREE.Material>} */
const materials = new Map();

/** Material of a surface. @param {string} name */
function materialOf(name) {
  if (!materials.has(name)) {
    const color = new THREE.Color(...(looks.surfaces[name] ?? looks.surfaces.asphalt));
    materials.set(name, new THREE.MeshStandardMaterial({ name, color, roughness: name === "wet" || name === "ice" ? 0.25 : 0.92 }));
  }
  return materials.get(name);
}

/** Bounds of the drawn ground along x and y. @param {import("./run.js").Run} run @param {number[][]} axes */
export const boundsNear = (run, axes) => axes.slice(0, 2).map((axis) => run.extentAlong(axis)).map(([low, high]) => [low - MARGIN, high + MARGIN]); // prettier-ignore

/** Mesh of a level or inclined road or a profile, to twice the size of the scene beyond the frames. @param {Data} road @param {import("./run.js").Run} run @param {number[]} up @returns {THREE.Mesh} */
export function plainRoad(road, run, up) {
  const ways = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => run.extentAlong(axis)); // prettier-ignore
  const reach = 0.5 * Math.hypot(...ways.map(([low, high]) => high - low)) + 2 * run.scene.extent;
  const asphalt = materialOf(slickName(gripOf(road)));
  const roads = makeRoads({ roads: [road] }, { up, asphalt, road: asphalt, grass: materialOf("grass"), extent: run.scene.extent, reach });
  roads.follow([0, 0, 0], ways.map(([low, high]) => 0.5 * (low + high)));
  return /** @type {THREE.Mesh} */ (roads.group.children[0]);
}

/** @typedef {{patch: import("../looks/heights.js").Patch, i0: number, j0: number, n: number, m: number}} Part */

/** Part of a patch in a rectangle; null if there is none. @param {import("../looks/heights.js").Patch} patch @param {number[][]} ways @returns {Part | null} */
function partWithin(patch, ways) {
  const [[i0, i1], [j0, j1]] = ways.map(([low, high], k) => {
    const at = (/** @type {number} */ value) => (value - patch.origin[k]) / patch.spacing[k];
    return [Math.max(0, Math.floor(at(low))), Math.min(patch.shape[k] - 1, Math.ceil(at(high)))];
  });
  return i0 < i1 && j0 < j1 ? { patch, i0, j0, n: i1 - i0 + 1, m: j1 - j0 + 1 } : null;
}

/**
 * Meshes of patches in a rectangle, thinned to at most `MAX_CELLS` cells.
 * @param {import("../looks/heights.js").Patch[]} patches @param {number[][]} ways low and high along x and y @param {(x: number, y: number) => string} nameAt name of the surface
 * @param {number} [border] continuation at both ends along x, m
 * @returns {{parts: Map<THREE.Material, THREE.BufferGeometry>, base: number[], error: number}} base: origin of
 *   the positions; error: largest error of a height, m
 */
function meshesOf(patches, ways, nameAt, border = 0) {
  const inside = patches.map((patch) => partWithin(patch, ways)).filter((part) => part !== null);
  let spacing = MIN_CELL;
  const stride = ({ patch }) => Math.max(1, Math.round(spacing / Math.sqrt(patch.spacing[0] * patch.spacing[1])));
  const lines = (part) => [part.n, part.m].map((n, k) => strided(n, stride(part)).map((line) => line + [part.i0, part.j0][k]));
  const cells = (part) => lines(part).reduce((product, { length: n }) => product * (n - 1), 1);
  while (inside.reduce((sum, part) => sum + cells(part), 0) > MAX_CELLS) spacing *= 2;
  const base = [...ways.map(([low, high]) => Math.round(0.5 * (low + high))), 0];
  /** @type {Object<string, {positions: number[], index: number[]}>} */
  const sheets = {};
  for (const part of inside) {
    const { patch, i0, n } = part;
    const [rows, columns] = lines(part).map((list, k) => list.map((line) => [line, patch.origin[k] + patch.spacing[k] * line]));
    if (i0 === 0) rows.unshift([0, rows[0][1] - border]);
    if (i0 + n === patch.shape[0]) rows.push([i0 + n - 1, rows[rows.length - 1][1] + border]);
    const numbers = new Map();
    const number = (name, a, b) => {
      const key = `${name} ${a} ${b}`;
      if (!numbers.has(key)) {
        const [[i, x], [j, y]] = [rows[a], columns[b]];
        numbers.set(key, sheets[name].positions.push(x - base[0], y - base[1], patch.heights[i * patch.shape[1] + j]) / 3 - 1);
      }
      return numbers.get(key);
    };
    for (let a = 0; a + 1 < rows.length; a++) {
      for (let b = 0; b + 1 < columns.length; b++) {
        const name = nameAt(0.5 * (rows[a][1] + rows[a + 1][1]), 0.5 * (columns[b][1] + columns[b + 1][1]));
        sheets[name] ??= { positions: [], index: [] };
        const [p, q, r, s] = [[a, b], [a + 1, b], [a, b + 1], [a + 1, b + 1]].map(([c, d]) => number(name, c, d)); // prettier-ignore
        sheets[name].index.push(p, q, r, q, s, r); // the same triangles as in the page
      }
    }
  }
  const parts = new Map(Object.entries(sheets).sort().map(([name, { positions, index }]) => {
    const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions), 3));
    return [materialOf(name), geometry.setIndex(index)];
  })); // prettier-ignore
  return { parts, base, error: inside.reduce((most, part) => Math.max(most, errorOf(part, stride(part))), 0) };
}

/** Meshes of a terrain, or of a road on a grid, near the path. @param {any} road @param {import("./run.js").Run} run @param {number[]} up */
export function heightMeshes(road, run, up) {
  const axes = [...(road.kind === "grid" ? groundAxes(road, up) : groundAxes({}, up)).slice(0, 2), up];
  const ways = boundsNear(run, axes);
  if (road.kind === "terrain") {
    const raster = new SurfaceRaster(road.surface);
    return { axes, ...meshesOf(new HeightField(road).patches, ways, (x, y) => raster.nameAt(x, y)) };
  }
  const frictions = road.frictions && floats(road.frictions);
  const nameAt = (x, y) => slickName(frictions ? frictions[nearest(road, x, y)] * (road.friction_factor ?? 1) : gripOf(road));
  return { axes, ...meshesOf([{ ...road, heights: floats(road.heights) }], ways, nameAt, looks.border) };
}

/**
 * Meshes of the paths of the reference point and the wheels; none without motion of the focus.
 * @param {import("./run.js").Run} run @param {number[]} up @returns {{name: string, mesh: THREE.Mesh}[]}
 */
export function pathMeshes(run, up) {
  const { scene, epoch } = run;
  const terrain = (scene.roads ?? []).find(({ kind }) => kind === "terrain");
  const field = terrain && new HeightField(terrain);
  const view = { scene, up, extent: scene.extent, floor: run.extentAlong(up)[0], look: field && { height: (x, y) => field.at(x, y) } };
  const ways = groundPaths(scene, run.count, (k) => run.lookup(k), view);
  const frames = [...new Set(scene.shapes.filter(({ kind }) => kind === "wheel").map(({ frame }) => frame))];
  return ways.flatMap(({ points, at }, n) => {
    const kept = [];
    points.forEach((point, k) => {
      const last = kept[kept.length - 1];
      if (k === 0 || epoch[at[k]] !== epoch[at[last]] || length(subtract(point, points[last])) >= POINT_DISTANCE * scene.extent) kept.push(k);
    });
    const [stretch, epochs, which] = [kept.map((k) => points[k]), kept.map((k) => epoch[at[k]]), Math.min(n, 1)];
    if (stretch.length < 2) return [];
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(ribbonEdges(stretch, epochs, 0.5 * SHARES[which] * scene.extent, up).edges, 3));
    geometry.setIndex(ribbonTriangles(epochs));
    const look = { name: "path", color: [BODY, WHEEL][which], opacity: OPACITIES[which], transparent: true, side: THREE.DoubleSide };
    const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial(look));
    mesh.position.fromArray(add(stretch[0], scale(up, PATH_HEIGHT - LIFT)));
    return [{ name: n === 0 ? "path" : `path ${frames[n - 1]}`, mesh }];
  });
}
