// A program of Node that writes a run as a glTF file: `node ali3-gltf.mjs REQUEST OUT`. The request is a line of JSON, then
// numbers of double precision: times, epochs and each column. Errors and notes are printed as JSON.
import fs from "node:fs";
import process from "node:process";
import * as THREE from "three";
import { Materials } from "../looks/materials.js";
import { groundAxes } from "../looks/roads.js";
import { unit } from "../scene/math.js";
import { makeShape } from "../shapes/index.js";
import { File } from "./file.js";
import { flexible } from "./flexible.js";
import { MARGIN, boundsNear, heightMeshes, pathMeshes, plainRoad } from "./ground.js";
import { fixed, lean, meshOf, moving } from "./meshes.js";
import { keptTimes } from "./motion.js";
import { Run } from "./run.js";
import { scenery } from "./scenery.js";

/** Largest distance from the origin for an error of single precision below 0.03 mm, m. */
const LARGEST_DISTANCE = 1000;
/** Change of form above which a note is made, m. */
const NOTED_CHANGE = 1e-3;
/** Visible error as a share of the size of the scene. */
const VISIBLE_ERROR = 2e-3;

const [requestFile, outFile] = process.argv.slice(2);
const input = fs.readFileSync(requestFile);
const end = input.indexOf("\n");
const { scene, names, count, name, rate, speed, begin, deformation, ground } = JSON.parse(input.toString("utf8", 0, end));
const numbers = new Float64Array(new Uint8Array(input.subarray(end + 1)).buffer);
const [t, epoch, ...columns] = Array.from({ length: names.length + 2 }, (_, n) => numbers.subarray(n * count, (n + 1) * count));
const run = new Run({ scene, t, epoch, columns: Object.fromEntries(names.map((column, n) => [column, columns[n]])) });
const materials = new Materials();
const file = new File(name, t, rate);
const notes = [];
const kept = keptTimes(t, rate);
const rounded = (/** @type {number} */ value, digits = 3) => String(Number(value.toPrecision(digits)));

const up = unit(scene.up ?? [0, 0, 1]);
const ends = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => run.extentAlong(axis)); // prettier-ignore
const isFar = ends.some(([low, high]) => Math.max(-low, high) >= LARGEST_DISTANCE);
/** Origin of all positions, in whole metres. */
const origin = new THREE.Vector3().fromArray(isFar ? ends.map(([low, high]) => Math.round(0.5 * (low + high))) : [0, 0, 0]);
/** Meshes of shapes and ground. @type {(import("./meshes.js").Piece & {title: string})[]} */
const pieces = scene.shapes.flatMap((shape) => {
  run.move(0);
  const part = makeShape(shape, { materials, frames: run.frames, scene, rigid: true });
  const shapePieces = part.frame === undefined ? moving(part, run, materials) : fixed(part.object, part.frame, materials);
  const title = shape.name || shape.body || shape.kind;
  const bent = Math.max(0, ...shapePieces.map((piece) => piece.bent ?? 0));
  if (bent > NOTED_CHANGE) notes.push(`The ${shape.kind} '${title}' changes its form; it keeps that of the start, and a corner is off by ${rounded(1000 * bent, 2)} mm at most.`);
  return shapePieces.map((piece) => ({ ...piece, title }));
});
const bending = (scene.flexible ?? []).map((part) => ({ part, ...flexible(part, run, deformation, materials.get("steel")) }));
if (pieces.length + bending.length > 0) {
  if (ground) addGround();
  addNodes();
  await file.write(outFile);
}
process.stdout.write(`${JSON.stringify({ times: kept.length, error: file.error, notes })}\n`);

/** Adds a mesh that is fixed to the earth. @param {string} title @param {THREE.Mesh | null} mesh */
function addFixed(title, mesh) {
  if (mesh !== null) pieces.push({ title, mesh, frame: "ground" });
}

/** Transforms a mesh from the axes of a world, relative to a base, to earth axes. @param {THREE.Mesh | null} mesh @param {number[]} base @param {number[][]} axes */
function toEarth(mesh, base, axes) {
  const [x, y, z] = axes.map((axis) => new THREE.Vector3().fromArray(axis));
  const basis = new THREE.Matrix4().makeBasis(x, y, z);
  mesh?.geometry.applyMatrix4(basis);
  mesh?.position.fromArray(base).applyMatrix4(basis);
  return mesh;
}

/** Adds roads, scenery and paths. */
function addGround() {
  for (const entry of scene.roads ?? []) {
    const title = entry.kind === "terrain" ? "terrain" : "road";
    if (entry.kind === "file") notes.push("The road of a file is not drawn.");
    else if (entry.kind !== "terrain" && entry.kind !== "grid") addFixed(title, merged(plainRoad(entry, run, up)));
    else {
      const { axes, parts, base, error } = heightMeshes(entry, run, up);
      addFixed(title, toEarth(meshOf(parts), base, axes));
      notes.push(`Of the ${title}, what is within ${MARGIN} m of the way is drawn; its heights are up to ${rounded(1000 * error, 2)} mm off.`);
    }
  }
  const axes = [...groundAxes({}, up), up];
  const { meshes, left } = scenery(scene.scenery ?? [], boundsNear(run, axes));
  for (const { kind, geometry, base, material } of meshes) addFixed(kind, toEarth(meshOf(new Map([[material, geometry]])), base, axes));
  if (left > 0) notes.push(`${left} things of the scenery are left out; the others stand by the way.`);
  for (const { name: title, mesh } of pathMeshes(run, up)) addFixed(title, merged(mesh));
}

/** Merges equal points of a mesh. @param {THREE.Mesh} mesh */
function merged(mesh) {
  mesh.geometry = lean(mesh.geometry);
  return mesh;
}

/** Adds all nodes; first those of frames, so that these keep their names. */
function addNodes() {
  const root = file.add(new THREE.Object3D(), name in scene.frames ? `scene ${name}` : name);
  root.quaternion.setFromUnitVectors(new THREE.Vector3(...up), new THREE.Vector3(0, 1, 0));
  if (isFar) for (const holder of [file.scene, root]) holder.userData = { origin: origin.toArray() };
  /** @type {Map<string, {node: THREE.Object3D, error: number[]}>} */
  const nodes = new Map();
  const frameOf = (frame) => {
    if (!nodes.has(frame)) {
      const { parent } = scene.frames[frame] ?? {};
      const parentNode = parent === undefined ? { node: root, error: [0, 0] } : frameOf(parent);
      const node = file.add(new THREE.Object3D(), frame, parentNode.node);
      const motion = { ...run.motionOf(frame), reach: reachOf(frame) };
      if (frame !== "ground" && (parent ?? "ground") === "ground") subtractOrigin(motion.position);
      nodes.set(frame, { node, error: frame === "ground" ? [0, 0] : file.animate(node, motion, parentNode.error) });
    }
    return nodes.get(frame);
  };
  for (const { frame } of pieces) if (frame !== undefined) frameOf(frame);
  for (const { part } of bending) frameOf(part.frame);
  for (const { title, mesh, motion } of pieces) {
    if (motion === undefined) continue;
    subtractOrigin(motion.position);
    file.animate(file.add(mesh, title, root), { ...motion, reach: cornersOf([mesh]) });
  }
  for (const { title, mesh, frame } of pieces) {
    if (frame === undefined) continue;
    if (frame === "ground") mesh.position.sub(origin);
    file.add(mesh, title, frameOf(frame).node);
  }
  for (const { part, mesh, peak } of bending) addFlexible(part, mesh, peak, frameOf(part.frame));
  addNotes(nodes.keys());
}

/** Makes positions relative to the origin, in place. @param {Float64Array} positions */
function subtractOrigin(positions) {
  for (let i = 0; i < positions.length; i++) positions[i] -= origin.getComponent(i % 3);
}

/** @param {string} frame @returns {THREE.Vector3[]} corners of the bounding box of meshes fixed in it */
function reachOf(frame) {
  const meshes = pieces.filter((piece) => piece.frame === frame).map(({ mesh }) => mesh);
  return cornersOf([...meshes, ...bending.filter(({ part }) => part.frame === frame).map(({ mesh }) => mesh)]);
}

/** Corners of the bounding box. @param {THREE.Mesh[]} meshes */
function cornersOf(meshes) {
  const box = new THREE.Box3();
  for (const { geometry, position } of meshes) {
    const own = new THREE.Box3().setFromBufferAttribute(/** @type {any} */ (geometry.getAttribute("position")));
    box.union(own.translate(position));
  }
  if (box.isEmpty()) return [new THREE.Vector3()];
  const { min, max } = box;
  return [min, max].flatMap(({ x }) => [min, max].flatMap(({ y }) => [min, max].map(({ z }) => new THREE.Vector3(x, y, z))));
}

/** Adds the mesh of a flexible part. @param {Data} part @param {THREE.Mesh} mesh @param {Data | null} peak @param {{node: THREE.Object3D, error: number[]}} on */
function addFlexible(part, mesh, peak, { node, error }) {
  const title = part.name || `flexible ${part.frame}`;
  file.add(mesh, title, node);
  if (part.weights.length > 0) {
    file.bend(mesh, kept, kept.flatMap((k) => part.weights.map((column) => run.columns[column][k])));
  }
  file.count([error[0] + deformation * part.reduction, 0]);
  if (peak === null) return;
  const unitOf = part.stress.unit ?? "Pa";
  const [stress, most] = [peak.stress, peak.end].map((value) => `${rounded(value)} ${unitOf}`);
  notes.push(`The colours of ${title} are those of its largest stress, ${stress}, at ${rounded(t[peak.k] * speed + begin)} s; they go from 0 to ${most}.`);
}

/** Adds notes on origin, errors and gaps. @param {Iterable<string>} nodes frames */
function addNotes(nodes) {
  if (isFar) {
    const [x, y, z] = origin.toArray();
    notes.push(
      `Places are relative to x = ${x} m, y = ${y} m, z = ${z} m, for numbers of a glTF file have seven digits; the extras of the scene and of its ` +
        "first node have them as origin.",
    );
  }
  const [off] = file.error;
  if (off > VISIBLE_ERROR * scene.extent) {
    notes.push(
      `Between the ${kept.length} times that were kept, something is up to ${rounded(1000 * off)} mm from where it was recorded; a higher rate or a ` +
        "lower speed keeps more times.",
    );
  }
  for (const frame of nodes) {
    const { hidden } = run.ways.get(frame);
    if (hidden > 0) notes.push(`${frame} stands still while its columns hold no numbers, ${hidden} times.`);
  }
}
