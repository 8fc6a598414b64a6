// Spheres.
import * as THREE from "three";

/** Makes a sphere. @param {Data} shape @param {import("./index.js").Context} context */
export function sphere(shape, { materials }) {
  const mesh = new THREE.Mesh(new THREE.SphereGeometry(shape.radius, 32, 20), materials.forShape(shape));
  mesh.position.fromArray(shape.at ?? [0, 0, 0]);
  return { object: mesh, frame: shape.frame };
}
