import * as THREE from "three";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { turnByAxes } from "./place.js";

/** A box with edges that catch the light. @param {Data} shape @param {import("./index.js").Context} context */
export function box(shape, { materials }) {
  const [x, y, z] = shape.size;
  const edge = Math.min(0.06 * Math.max(x, y, z), 0.12 * Math.min(x, y, z));
  const mesh = new THREE.Mesh(new RoundedBoxGeometry(x, y, z, 2, edge), materials.of(shape));
  mesh.position.fromArray(shape.at ?? [0, 0, 0]);
  turnByAxes(mesh, shape.axes);
  return { object: mesh, frame: shape.frame };
}
