// Shapes as triangles, and how they move, for files: a program of Node that reads a file and writes JSON. The file has a
// line of JSON, then the poses of frames: 7 numbers of double precision for each frame and time, position and quaternion.
import { Buffer } from "node:buffer";
import fs from "node:fs";
import process from "node:process";
import * as THREE from "three";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import looks from "../../looks.json" with { type: "json" };
import { Materials } from "./looks/materials.js";
import { addLine, addStrip } from "./looks/scenery/index.js";
import { PAINTS, arrowStrips } from "./looks/scenery/ribbon.js";
import { addSign } from "./looks/scenery/signs.js";
import { coneGeometry, postGeometry, turned } from "./looks/scenery/small_things.js";
import { Triangles } from "./looks/scenery/triangles.js";
import { addBarrier, addBuilding } from "./looks/scenery/walls.js";
import { Frames } from "./scene/frames.js";
import { fromQuaternion, length, rotate, subtract, transpose } from "./scene/math.js";
import { FrameTubes } from "./shapes/frame_tubes.js";
import { makeShape } from "./shapes/index.js";
import { plain } from "./shapes/merged_meshes.js";

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

/**
 * What triangles share stands once; triangles without an area are left out.
 * @param {THREE.BufferGeometry} geometry @param {number[]} [base] to which its positions, of single precision, are relative
 */
function solidOf(geometry, base = [0, 0, 0]) {
  geometry.deleteAttribute("aside");
  const merged = mergeVertices(geometry, SAME);
  const [points, normals] = ["position", "normal"].map((name) => Float32Array.from(merged.getAttribute(name).array));
  const [triangles, triangle] = [[], new THREE.Triangle()];
  for (let i = 0; i < merged.index.count; i += 3) {
    const three = [0, 1, 2].map((k) => merged.index.getX(i + k));
    triangle.setFromAttributeAndIndices(merged.getAttribute("position"), three[0], three[1], three[2]);
    if (triangle.getArea() > 0) triangles.push(...three);
  }
  const lit = normals.every((_, i) => i % 3 > 0 || length(normals.subarray(i, i + 3)) > 0);
  const colors = merged.getAttribute("color") ? text(Float32Array.from(merged.getAttribute("color").array)) : null;
  return { base, positions: text(points), normals: lit ? text(normals) : null, colors, triangles: text(Uint32Array.from(triangles)) };
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
  const base = new THREE.Vector3().setFromMatrixPosition(meshes[0].matrixWorld);
  const place = (mesh) => mesh.matrixWorld.clone().setPosition(new THREE.Vector3().setFromMatrixPosition(mesh.matrixWorld).sub(base));
  const parts = [...new Set(meshes.map(({ material }) => material))].map((material) => {
    const same = meshes.filter((mesh) => mesh.material === material);
    return { ...solidOf(mergeGeometries(same.map((mesh) => plain(mesh, place(mesh)))), base.toArray()), look: lookOf(material) };
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
    for (const [, values] of track) for (let k = 0; k < first[n]; k++) values.set(row(values, first[n]), k * (values.length / count));
    const { round = false, bent = 0 } = mesh.userData;
    const home = round || mesh.quaternion.w !== 1 ? null : homeOf(tracks[n].position, known);
    const parts = [{ ...solidOf(plain(mesh, new THREE.Matrix4()), home?.place), look: lookOf(mesh.material) }];
    const how = home === null ? { round, bent, ...Object.fromEntries(track.map(([path, values]) => [path, text(values)])) } : { frame: home.frame };
    return [{ ...how, parts }];
  });
}

/** @param {Float64Array} values @param {number} k of the time */
const row = (values, k) => values.subarray((k * values.length) / count, ((k + 1) * values.length) / count);

/** A frame in which a point does not move, and its place there. @param {Float64Array} positions @param {string[]} known @returns {{frame: string, place: [number, number, number]} | null} */
function homeOf(positions, known) {
  const within = (name, k) => {
    const { position, rotation } = name === "ground" ? frames.pose(name) : poseAt(names.indexOf(name), k);
    return rotate(transpose(rotation), subtract([...row(positions, k)], position));
  };
  for (const frame of known) {
    const place = /** @type {[number, number, number]} */ (within(frame, 0));
    let still = true;
    for (let k = 0; k < count && still; k++) still = length(subtract(within(frame, k), place)) <= STILL * (1 + length([...row(positions, k)]));
    if (still) return { frame, place };
  }
  return null;
}

/** A geometry that stands somewhere. @param {Triangles} made @param {THREE.BufferGeometry} geometry @param {number[]} at @param {number[]} size */
function stand(made, geometry, at, size) {
  const [points, normals, colours] = ["position", "normal", "color"].map((name) => geometry.getAttribute(name).array);
  const vector = (values, i) => [...values.subarray(3 * i, 3 * i + 3)];
  const first = made.positions.length / 3;
  for (let i = 0; i < points.length / 3; i++) {
    made.point(vector(points, i).map((value, k) => at[k] + size[k] * value), vector(normals, i), vector(colours, i));
  }
  made.index.push(...[...geometry.index.array].map((number) => first + number));
}

/** A board without words, and what carries it. */
function sign(made, thing) {
  const board = new Triangles();
  addSign(board, made, thing, 0, 1);
  const [a, b, c, d] = [0, 3, 6, 9].map((k) => board.positions.slice(k, k + 3));
  made.quad([a, b, c, d], looks.things.board);
}

/** Trunk and crown; pages have twigs. */
function tree(made, { at, height }) {
  const rings = (colour, profile) => profile.map(([radius, z]) => ({ radius, z, colour }));
  const whole = new Triangles();
  turned(whole, rings(looks.things.bark, [[0.028, -0.01], [0.014, 0.5]]), 5); // prettier-ignore
  turned(whole, rings(looks.things.leaves, [[0.001, 0.22], [0.2, 0.34], [0.24, 0.55], [0.14, 0.83], [0.001, 1]]), 7); // prettier-ignore
  stand(made, whole.geometry(), at, [height, height, height]);
}

/** @type {Object<string, (made: Triangles, thing: Data) => void>} */
const THINGS = {
  line: (made, line) => addLine(made, line, null),
  arrow: (made, arrow) => arrowStrips(/** @type {any} */ (arrow), null).forEach((strip) => addStrip(made, strip, PAINTS.white)),
  barrier: (made, barrier) => addBarrier(made, /** @type {any} */ (barrier)),
  building: addBuilding,
  sign,
  tree,
  cone: (made, { at: place, colour, height = 0.5 }) => stand(made, coneGeometry(colour), place, [height, height, height]),
  post: (made, { at: place, height = 1 }) => stand(made, postGeometry(), place, [1, 1, height]),
};

/** What of a scenery is of one kind, in the axes of its world: x, y and up. @param {string} kind */
function scenery(kind) {
  const things = scene.scenery.filter((thing) => thing.kind === kind);
  const made = new Triangles(things[0].at ?? things[0].points[0]);
  for (const thing of things) THINGS[kind](made, thing);
  return solidOf(made.geometry(), made.base);
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
  return { base: [0, 0, 0], positions, normals, colors: null, triangles: text(Uint32Array.from(tubes.geometry.index.array)) };
});
const kinds = [...new Set((scene.scenery ?? []).map(({ kind }) => kind))];
const things = Object.fromEntries(kinds.map((kind) => [kind, scenery(kind)]));
process.stdout.write(`${JSON.stringify({ shapes, flexible, things })}\n`);
