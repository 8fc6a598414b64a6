// Round tubes.
import * as THREE from "three";
import { stretch } from "./place.js";

const rod = (material) => new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 12, 1, true), material);

/** Makes round tubes between points with balls at the points; `place` moves them. */
export function roundTubes(count, closed, radius, material) {
  const group = new THREE.Group();
  const rods = Array.from({ length: closed ? count : count - 1 }, () => rod(material));
  for (const mesh of rods) mesh.userData.tubes = [new THREE.Matrix4()];
  const ball = new THREE.SphereGeometry(radius, 10, 6);
  const balls = Array.from({ length: count }, () => new THREE.Mesh(ball, material));
  for (const mesh of balls) mesh.userData.tubes = []; // drafts have no balls
  group.add(...rods, ...balls);
  const place = (points) => {
    rods.forEach((mesh, i) => stretch(mesh, points[i], points[(i + 1) % count], radius));
    balls.forEach((mesh, i) => mesh.position.fromArray(points[i]));
  };
  return { group, place };
}

/** Makes a tube through points of any frames. @param {Data} shape @param {import("./index.js").Context} context */
export function tube(shape, { materials }) {
  const { points, radius } = shape;
  const { group, place } = roundTubes(points.length, false, radius, materials.forShape(shape, "steel"));
  const frame = points[0][0];
  if (points.every(([other]) => other === frame)) {
    place(points.map(([, local]) => local));
    return { object: group, frame };
  }
  return { object: group, update: (at) => place(points.map(at)) };
}
