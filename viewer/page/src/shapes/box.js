// Boxes.
import * as THREE from "three";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { turnByAxes } from "./place.js";

/** Geometry of a box with rounded edges. @param {number[]} size m */
export function rounded([x, y, z]) {
  const edge = Math.min(0.06 * Math.max(x, y, z), 0.12 * Math.min(x, y, z));
  return new RoundedBoxGeometry(x, y, z, 2, edge);
}

/** Makes a box. @param {Data} shape @param {import("./index.js").Context} context */
export function box(shape, { materials }) {
  const mesh = new THREE.Mesh(rounded(shape.size), materials.forShape(shape));
  mesh.position.fromArray(shape.at ?? [0, 0, 0]);
  turnByAxes(mesh, shape.axes);
  return { object: mesh, frame: shape.frame };
}
