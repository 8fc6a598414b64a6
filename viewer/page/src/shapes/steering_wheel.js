// Steering wheels.
import * as THREE from "three";
import shapes from "../../../shapes.json" with { type: "json" };
import { across, cross, fromColumns, perpendicular, rotate, transpose, unit } from "../scene/math.js";
import { composed } from "./composite_solids.js";
import { turn } from "./place.js";

/** Makes a steering wheel about the axis of its frame, with a mark at the top as drawn. @param {Data} shape */
export function steeringWheel(shape, { materials, frames, scene }) {
  const { radius, frame } = shape;
  const axis = unit(shape.axis ?? scene.frames?.[frame]?.axis ?? [0, 0, 1]) ?? [0, 0, 1];
  const look = (part) => (part.of_shape ? materials.forShape({ color: part.color, ...shape }, part.material) : materials.get(part.material, { color: part.color }));
  const object = new THREE.Group().add(...composed(shapes.steering_wheel.parts, { radius }, look));
  const up = rotate(transpose(frames.pose(frame).rotation), scene.up ?? [0, 0, 1]);
  const top = perpendicular(up, axis) ?? across(axis);
  turn(object, fromColumns(cross(axis, top), axis, top));
  object.position.fromArray(shape.at ?? [0, 0, 0]);
  return { object, frame };
}
