import * as THREE from "three";
import { across, cross, dot, fromColumns, rotate, scale, subtract, transpose, unit } from "../scene/math.js";
import { turn } from "./place.js";

/** A steering wheel about the axis of its frame, with a mark that stands on top as drawn. @param {Data} shape */
export function steeringWheel(shape, { materials, frames, scene }) {
  const { radius, frame } = shape;
  const axis = unit(shape.axis ?? scene.frames?.[frame]?.axis ?? [0, 0, 1]) ?? [0, 0, 1];
  const rim = 0.09 * radius;
  const dark = materials.of({ color: "#1c1e20", ...shape }, "plastic");
  const ring = new THREE.Mesh(new THREE.TorusGeometry(radius - rim, rim, 10, 48), dark);
  const hub = new THREE.Mesh(new THREE.CylinderGeometry(0.26 * radius, 0.3 * radius, 0.2 * radius, 32).rotateX(Math.PI / 2), dark);
  const spoke = new THREE.BoxGeometry(0.72 * radius, 0.16 * radius, 0.07 * radius).translate(0.55 * radius, 0, 0);
  const spokes = [0, Math.PI, -Math.PI / 2].map((angle) => {
    const mesh = new THREE.Mesh(spoke, materials.named("steel"));
    mesh.rotation.z = angle;
    return mesh;
  });
  const markShape = new THREE.TorusGeometry(radius - rim, 1.12 * rim, 12, 6, 0.22).rotateZ(Math.PI / 2 - 0.11);
  const mark = new THREE.Mesh(markShape, materials.named("plastic", "#d8412f"));
  const object = new THREE.Group().add(ring, hub, mark, ...spokes);
  const up = rotate(transpose(frames.pose(frame).rotation), scene.up ?? [0, 0, 1]);
  const y = unit(subtract(up, scale(axis, dot(up, axis)))) ?? across(axis);
  turn(object, fromColumns(cross(y, axis), y, axis));
  object.position.fromArray(shape.at ?? [0, 0, 0]);
  return { object, frame };
}
