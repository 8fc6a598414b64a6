// Meshes of shapes, one for each frame and material, and the motion of shapes between frames.
import * as THREE from "three";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { length, rotate, subtract, transpose } from "../scene/math.js";
import { plain } from "../shapes/merged_meshes.js";
import { continuous, leastTwist } from "./motion.js";
import { row } from "./run.js";

/** Distance of points that are merged, m; relative deviation of a point that is fixed in a frame. */
const [MERGE_DISTANCE, FIXED_DEVIATION] = [1e-7, 1e-9];

/** A mesh, with the frame that it is fixed in or its motion in the earth. @typedef {{mesh: THREE.Mesh, frame?: string, motion?: import("./motion.js").Motion, bent?: number}} Piece */

/** Geometry with equal points merged, without degenerate triangles and unused attributes. @param {THREE.BufferGeometry} geometry */
export function lean(geometry) {
  for (const name of Object.keys(geometry.attributes)) if (!["position", "normal", "color"].includes(name)) geometry.deleteAttribute(name);
  const merged = mergeVertices(geometry, MERGE_DISTANCE);
  const [kept, triangle] = [[], new THREE.Triangle()];
  for (let i = 0; i < merged.index.count; i += 3) {
    const corners = [0, 1, 2].map((k) => merged.index.getX(i + k));
    triangle.setFromAttributeAndIndices(merged.getAttribute("position"), corners[0], corners[1], corners[2]);
    if (triangle.getArea() > 0) kept.push(...corners);
  }
  merged.setIndex(kept);
  const { array = [] } = merged.getAttribute("normal") ?? {};
  for (let k = 0; k < array.length; k += 3) if (!(Math.hypot(array[k], array[k + 1], array[k + 2]) > 0)) return merged.deleteAttribute("normal");
  return merged;
}

/** One mesh of geometries by material; null without triangles. @param {Map<THREE.Material, THREE.BufferGeometry>} parts @returns {THREE.Mesh | null} */
export function meshOf(parts) {
  const found = [...parts].map(([material, geometry]) => ({ material, geometry: lean(geometry) })).filter(({ geometry }) => geometry.index.count > 0);
  if (found.length === 0) return null;
  const [materials, geometries] = [found.map(({ material }) => material), found.map(({ geometry }) => geometry)];
  if (found.length === 1) return new THREE.Mesh(geometries[0], materials[0]);
  if (!geometries.every((geometry) => geometry.hasAttribute("normal"))) for (const geometry of geometries) geometry.deleteAttribute("normal");
  return new THREE.Mesh(mergeGeometries(geometries, true), materials);
}

/** Meshes of an object. @param {THREE.Object3D} object @returns {Data[]} */
function meshesIn(object) {
  const found = [];
  object.updateMatrixWorld(true);
  object.traverse((part) => part instanceof THREE.Mesh && found.push(part));
  return found;
}

/** A material without texture. @param {Data} material @param {Data} materials */
const untextured = (material, materials) => (material.map ? materials.get(material.name) : material);

/** Mesh of an object that is fixed in a frame, relative to its first mesh. @param {THREE.Object3D} object @param {string} frame @param {Data} materials @returns {Piece[]} */
export function fixed(object, frame, materials) {
  const meshes = meshesIn(object);
  const base = new THREE.Vector3().setFromMatrixPosition(meshes[0].matrixWorld);
  const place = (mesh) => mesh.matrixWorld.clone().setPosition(new THREE.Vector3().setFromMatrixPosition(mesh.matrixWorld).sub(base));
  const parts = new Map();
  for (const material of new Set(meshes.map((mesh) => mesh.material))) {
    const same = meshes.filter((mesh) => mesh.material === material);
    parts.set(untextured(material, materials), mergeGeometries(same.map((mesh) => plain(mesh, place(mesh)))));
  }
  const mesh = meshOf(parts);
  mesh?.position.copy(base);
  return mesh ? [{ mesh, frame }] : [];
}

/**
 * Meshes that `update` moves: with their motion, or fixed in a frame if they do not move in it.
 * @param {Data} made of `makeShape` @param {import("./run.js").Run} run @param {Data} materials @returns {Piece[]}
 */
export function moving({ object, update, frames: known }, run, materials) {
  const { count } = run;
  const meshes = meshesIn(object);
  const sizes = { position: 3, quaternion: 4, scale: 3 };
  const tracks = meshes.map(() => Object.fromEntries(Object.entries(sizes).map(([path, size]) => [path, new Float64Array(size * count)])));
  const first = meshes.map(() => count);
  for (let k = 0; k < count; k++) {
    run.move(k, known);
    update(([frame, local]) => run.frames.point(frame, local));
    meshes.forEach((mesh, n) => {
      if (object.visible && mesh.visible) first[n] = Math.min(first[n], k);
      for (const [path, size] of Object.entries(sizes)) mesh[path].toArray(tracks[n][path], k * size);
    });
  }
  const pieces = meshes.map((whole, n) => {
    if (first[n] === count) return null; // never visible
    for (const [path, size] of Object.entries(sizes)) for (let k = 0; k < first[n]; k++) tracks[n][path].copyWithin(size * k, size * first[n], size * (first[n] + 1));
    const { round = false, bent = 0 } = whole.userData;
    const mesh = meshOf(new Map([[untextured(whole.material, materials), plain(whole, new THREE.Matrix4())]]));
    if (mesh === null) return null;
    const fixture = round || whole.quaternion.w !== 1 ? null : fixtureOf(tracks[n].position, known, run);
    if (fixture !== null) {
      mesh.position.fromArray(fixture.place);
      return { mesh, frame: fixture.frame };
    }
    (round ? leastTwist : continuous)(tracks[n].quaternion);
    return { mesh, motion: /** @type {any} */ (tracks[n]), bent };
  });
  return pieces.filter((piece) => piece !== null);
}

/** A frame in which a point does not move, and its position in it; null if there is none. @param {Float64Array} positions @param {string[]} known @param {import("./run.js").Run} run */
function fixtureOf(positions, known, run) {
  const within = (name, k) => {
    const { position, rotation } = run.pose(name, k);
    return rotate(transpose(rotation), subtract(row(positions, k, 3), position));
  };
  for (const frame of known) {
    const place = within(frame, 0);
    let isFixed = true;
    for (let k = 0; k < run.count && isFixed; k++) isFixed = length(subtract(within(frame, k), place)) <= FIXED_DEVIATION * (1 + length(row(positions, k, 3)));
    if (isFixed) return { frame, place };
  }
  return null;
}
