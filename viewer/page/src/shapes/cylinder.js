// Cylinders with bevelled edges.
import * as THREE from "three";
import { length, middle, subtract, unit } from "../scene/math.js";
import { alongY, turn } from "./place.js";

/** Profile of a cylinder along y with a narrow bevel, from axis to axis. @returns {THREE.Vector2[]} */
export function bevelled(radius, height) {
  const edge = Math.min(0.08 * radius, 0.08 * height);
  const [r, h] = [radius - edge, height / 2];
  return [[0, -h], [r, -h], [r, -h], [radius, edge - h], [radius, edge - h], [radius, h - edge], [radius, h - edge], [r, h], [r, h], [0, h]].map(
    ([x, y]) => new THREE.Vector2(x, y),
  );
}

/** Makes a cylinder. @param {Data} shape @param {import("./index.js").Context} context */
export function cylinder(shape, { materials }) {
  const [a, b] = shape.ends;
  const along = subtract(b, a);
  const mesh = new THREE.Mesh(new THREE.LatheGeometry(bevelled(shape.radius, length(along)), 32), materials.forShape(shape));
  mesh.position.fromArray(middle(a, b));
  turn(mesh, alongY(unit(along) ?? [0, 1, 0]));
  return { object: mesh, frame: shape.frame };
}
