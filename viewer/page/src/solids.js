// Shapes as triangles, and how they move, for files: a program of Node that reads a file and writes JSON. The file has a
// line of JSON, then the poses of frames: 7 numbers of double precision for each frame and time, position and quaternion.
import { Buffer } from "node:buffer";
import fs from "node:fs";
import process from "node:process";
import * as THREE from "three";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { Materials } from "./looks/materials.js";
import { Frames } from "./scene/frames.js";
import { fromQuaternion, length, rotate, subtract, transpose } from "./scene/math.js";
import { FrameTubes } from "./shapes/frame_tubes.js";
import { makeShape } from "./shapes/index.js";
import { plain } from "./shapes/joined.js";

/** Points nearer than this are one, m; what stays so near to a place in a frame, beside the way to it, is fixed there. */
const [SAME, STILL] = [1e-7, 1e-9];

const input = fs.readFileSync(process.argv[2]);
const end = input.indexOf("\n");
const { scene, names, count } = JSON.parse(input.toString("utf8", 0, end));
const numbers = new Float64Array(new Uint8Array(input.subarray(end + 1)).buffer);
const frames = new Frames(scene);
const materials = new Materials();

/** @param {number} i of the frame @param {number} k of the time @returns {import("./scene/frames.js").Pose} */
function poseAt(i, k) {
  const [x, y, z, ...quaternion] = numbers.subarray(7 * (i * count + k), 7 * (i * count + k + 1));
  return { position: [x, y, z], rotation: fromQuaternion(quaternion), shown: true, why: "" };
}

/** Puts frames where they are at a time. @param {number} k of the time @param {string[]} [moved] */
const move = (k, moved = names) => moved.forEach((name) => name === "ground" || frames.poses.set(name, poseAt(names.indexOf(name), k)));

const text = (/** @type {{buffer: ArrayBufferLike}} */ { buffer }) => Buffer.from(buffer).toString("base64");

/** What triangles share stands once; triangles without an area are left out. @param {THREE.BufferGeometry} geometry */
function solidOf(geometry) {
  const merged = mergeVertices(geometry, SAME);
  const [points, normals] = ["position", "normal"].map((name) => Float32Array.from(merged.getAttribute(name).array));
  const [triangles, triangle] = [[], new THREE.Triangle()];
  for (let i = 0; i < merged.index.count; i += 3) {
    const three = [0, 1, 2].map((k) => merged.index.getX(i + k));
    triangle.setFromAttributeAndIndices(merged.getAttribute("position"), three[0], three[1], three[2]);
    if (triangle.getArea() > 0) triangles.push(...three);
  }
  const lit = normals.every((_, i) => i % 3 > 0 || length(normals.subarray(i, i + 3)) > 0);
  return { positions: text(points), normals: lit ? text(normals) : null, triangles: text(Uint32Array.from(triangles)) };
}

/** @param {Data} material of three.js; a picture on it is left out */
function lookOf(material) {
  const { name, color, opacity, metalness, roughness, clearcoat, clearcoatRoughness, side } = material.map ? materials.named(material.name) : material;
  const coat = clearcoat > 0 ? [clearcoat, clearcoatRoughness] : null;
  return { name, color: [...color.toArray(), opacity], metalness, roughness, clearcoat: coat, double: side === THREE.DoubleSide };
}

/** @param {THREE.Object3D} object @returns {any[]} */
function meshesOf(object) {
  const found = [];
  object.updateMatrixWorld(true);
  object.traverse((part) => part instanceof THREE.Mesh && found.push(part));
  return found;
}

/** One solid a look. @param {THREE.Object3D} object @param {string} frame */
function fixed(object, frame) {
  const meshes = meshesOf(object);
  const parts = [...new Set(meshes.map(({ material }) => material))].map((material) => {
    const same = meshes.filter((mesh) => mesh.material === material);
    return { ...solidOf(mergeGeometries(same.map((mesh) => plain(mesh, mesh.matrixWorld)))), look: lookOf(material) };
  });
  return { frame, parts };
}

/** Meshes that `update` places: with their places over time, or in the frame in which they stand still. @returns {Data[]} */
function moving(/** @type {Data} */ { object, update, frames: known }) {
  const meshes = meshesOf(object);
  const tracks = meshes.map(() => ({ position: new Float64Array(3 * count), quaternion: new Float64Array(4 * count), scale: new Float64Array(3 * count) }));
  const first = meshes.map(() => count);
  for (let k = 0; k < count; k++) {
    move(k, known);
    update(([frame, local]) => frames.point(frame, local));
    meshes.forEach((mesh, n) => {
      if (object.visible && mesh.visible) first[n] = Math.min(first[n], k);
      for (const [path, values] of Object.entries(tracks[n])) mesh[path].toArray(values, k * (values.length / count));
    });
  }
  return meshes.flatMap((mesh, n) => {
    const track = Object.entries(tracks[n]);
    if (first[n] === count) return []; // it has no direction at any time
    for (const [, values] of track) for (let k = 0; k < first[n]; k++) values.set(at(values, first[n]), k * (values.length / count));
    const { round = false, bent = 0 } = mesh.userData;
    const home = round || mesh.quaternion.w !== 1 ? null : homeOf(tracks[n].position, known);
    const place = new THREE.Matrix4().setPosition(...(home?.place ?? [0, 0, 0]));
    const parts = [{ ...solidOf(plain(mesh, place)), look: lookOf(mesh.material) }];
    const how = home === null ? { round, bent, ...Object.fromEntries(track.map(([path, values]) => [path, text(values)])) } : { frame: home.frame };
    return [{ ...how, parts }];
  });
}

/** @param {Float64Array} values @param {number} k of the time */
const at = (values, k) => values.subarray((k * values.length) / count, ((k + 1) * values.length) / count);

/** A frame in which a point does not move, and its place there. @param {Float64Array} positions @param {string[]} known @returns {{frame: string, place: [number, number, number]} | null} */
function homeOf(positions, known) {
  const within = (name, k) => {
    const { position, rotation } = name === "ground" ? frames.pose(name) : poseAt(names.indexOf(name), k);
    return rotate(transpose(rotation), subtract([...at(positions, k)], position));
  };
  for (const frame of known) {
    const place = /** @type {[number, number, number]} */ (within(frame, 0));
    let still = true;
    for (let k = 0; k < count && still; k++) still = length(subtract(within(frame, k), place)) <= STILL * (1 + length([...at(positions, k)]));
    if (still) return { frame, place };
  }
  return null;
}

move(0);
const shapes = scene.shapes.map((shape) => {
  move(0);
  const made = /** @type {Data} */ (makeShape(shape, { materials, frames, scene, rigid: true }));
  return made.frame === undefined ? moving(made) : [fixed(made.object, made.frame)];
});
const flexible = (scene.flexible ?? []).map(({ nodes, beams, radii = [] }) => {
  const tubes = new FrameTubes(nodes, beams, radii);
  tubes.move(nodes);
  const [positions, normals] = ["position", "normal"].map((name) => text(tubes.geometry.getAttribute(name).array));
  return { positions, normals, triangles: text(Uint32Array.from(tubes.geometry.index.array)) };
});
process.stdout.write(`${JSON.stringify({ shapes, flexible })}\n`);
