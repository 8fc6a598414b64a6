// Meshes of a scene.
import * as THREE from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { floats, integers } from "../bytes.js";
import { cross, dot } from "../scene/math.js";
import { turnByAxes } from "./place.js";

/** Angle above which edges of meshes without normals are sharp, rad. */
const CREASE = Math.PI / 6;

/** Makes a mesh of `meshes` of the scene. @param {Data} shape @param {import("./index.js").Context} context */
export function mesh(shape, { materials, scene }) {
  const data = scene.meshes?.[shape.mesh];
  if (data === undefined) throw new Error(`The mesh '${shape.mesh}' is not in the scene.`);
  let geometry = new THREE.BufferGeometry();
  const [points, triangles] = [floats(data.positions), integers(data.triangles)];
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  if (insideOut(points, triangles)) for (let i = 0; i < triangles.length; i += 3) [triangles[i], triangles[i + 1]] = [triangles[i + 1], triangles[i]];
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  if (data.normals !== undefined) geometry.setAttribute("normal", new THREE.BufferAttribute(floats(data.normals), 3));
  else geometry = toCreasedNormals(geometry, CREASE);
  const object = new THREE.Mesh(geometry, materials.forShape(shape, "plastic", { doubleSided: true }));
  object.userData.cover = shape.cover;
  object.position.fromArray(shape.at ?? [0, 0, 0]);
  turnByAxes(object, shape.axes);
  return { object, frame: shape.frame };
}

/**
 * Whether triangles are oriented inward: their enclosed volume is negative.
 * @param {Float32Array} points @param {Uint32Array} triangles
 */
export function insideOut(points, triangles) {
  const middle = [0, 0, 0];
  points.forEach((x, i) => (middle[i % 3] += (3 * x) / points.length));
  const at = (i) => [0, 1, 2].map((k) => points[3 * i + k] - middle[k]);
  let volume = 0;
  for (let i = 0; i < triangles.length; i += 3) volume += dot(at(triangles[i]), cross(at(triangles[i + 1]), at(triangles[i + 2])));
  return volume < 0;
}
