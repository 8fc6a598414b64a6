import * as THREE from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { floats, integers } from "../scene/data.js";
import { turnByAxes } from "./place.js";

/** Edges sharper than this stay edges where a mesh brings no normals. */
const CREASE = Math.PI / 6;

/** A mesh of the scene's `meshes`. @param {object} shape @param {import("./index.js").Context} context */
export function mesh(shape, { materials, scene }) {
  const data = scene.meshes?.[shape.mesh];
  if (data === undefined) throw new Error(`The mesh '${shape.mesh}' is not in the scene.`);
  let geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(floats(data.positions), 3));
  geometry.setIndex(new THREE.BufferAttribute(integers(data.triangles), 1));
  if (data.normals !== undefined) geometry.setAttribute("normal", new THREE.BufferAttribute(floats(data.normals), 3));
  else geometry = toCreasedNormals(geometry, CREASE);
  const object = new THREE.Mesh(geometry, materials.of(shape, "plastic", { double: true }));
  object.position.set(...(shape.at ?? [0, 0, 0]));
  turnByAxes(object, shape.axes);
  return { object, frame: shape.frame };
}
