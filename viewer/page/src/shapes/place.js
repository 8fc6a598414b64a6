// Sets poses of objects of three.js, and numbers at their points.
import * as THREE from "three";
import { across, cross, fromColumns, subtract, toQuaternion, unit } from "../scene/math.js";

/** Rotation that maps y to a direction. @param {number[]} direction unit vector */
export function alongY(direction) {
  const x = across(direction);
  return fromColumns(x, direction, cross(x, direction));
}

/** Sets a rotation. @param {THREE.Object3D} object @param {number[]} rotation nine numbers, row by row */
export function turn(object, rotation) {
  const [w, x, y, z] = toQuaternion(rotation);
  object.quaternion.set(x, y, z, w);
}

/** Sets the rotation of `axes` of a shape (three vectors), if there are any. @param {number[][] | undefined} axes */
export function turnByAxes(object, axes) {
  if (axes) turn(object, fromColumns(...axes));
}

/** Stretches a round mesh of radius 1 and height 1 along y between two points. */
export function stretch(mesh, from, to, radius) {
  mesh.userData.round = true;
  const along = subtract(to, from);
  const direction = unit(along);
  mesh.visible = direction !== null;
  if (direction === null) return;
  mesh.position.set((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (from[2] + to[2]) / 2);
  mesh.scale.set(radius, Math.hypot(...along), radius);
  turn(mesh, alongY(direction));
}

/** Matrix that stretches a cylinder of radius 1 and height 1 along y between two points. @returns {THREE.Matrix4} */
export function between(from, to, radius) {
  const object = new THREE.Object3D();
  stretch(object, from, to, radius);
  object.updateMatrix();
  return object.matrix;
}

/** Makes the meshes of an object cast and receive shadows. @param {THREE.Object3D} object */
export function shaded(object) {
  object.traverse((part) => {
    if (part instanceof THREE.Mesh) part.castShadow = part.receiveShadow = true;
  });
  return object;
}

/** Sets the numbers of an attribute; a buffer of the same size is reused. */
export function setNumbers(geometry, name, numbers, size = 3) {
  const attribute = geometry.getAttribute(name);
  if (attribute?.array.length === numbers.length) {
    attribute.array.set(numbers);
    attribute.needsUpdate = true;
  } else {
    geometry.setAttribute(name, new THREE.BufferAttribute(Float32Array.from(numbers), size));
  }
}
