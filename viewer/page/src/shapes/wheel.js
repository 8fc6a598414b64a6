// Wheels with tyres.
import * as THREE from "three";
import shapes from "../../../shapes.json" with { type: "json" };
import { atEachPoint } from "../looks/vertex_code.js";
import { cross, dot, fromColumns, rotate, sideways, subtract, transpose, unit } from "../scene/math.js";
import { composed, profileOf } from "./composite_solids.js";
import { turn } from "./place.js";
import { treadTexture } from "./tread.js";

/** @type {Data} */
const WHEEL = shapes.wheel;

/** Makes rubber with tread blocks and lines on the side. */
function rubber(part, lengths, materials) {
  const material = materials.get("rubber").clone();
  if (!materials.options.ghost) {
    const start = part.tread / (profileOf(part, lengths).length - 1);
    material.color.set("#48494c");
    material.map = treadTexture([start, 1 - start]);
  }
  return material;
}

/**
 * Flattens a tyre on the road: points below a plane are moved to it.
 * @param {THREE.Material} material
 * @returns {THREE.Vector4} the plane in the axes of the mesh: normal, and its distance from the origin along the normal
 */
function flattened(material) {
  const plane = new THREE.Vector4(0, 0, 0, -1);
  material.onBeforeCompile = (shader) => {
    shader.uniforms.road = { value: plane };
    atEachPoint(shader, "uniform vec4 road;", "transformed -= min(dot(transformed, road.xyz) - road.w, 0.0) * road.xyz;");
  };
  return plane;
}

/** Side of the car of a wheel, along its axis: 1, -1, or 0 in the middle. */
function outward(shape, axis, { frames, scene }) {
  const body = frames.pose(scene.focus || "ground");
  const { position, rotation } = frames.pose(shape.frame);
  const to = rotate(transpose(rotation), subtract(position, body.position));
  const along = dot(to, axis);
  return Math.abs(along) > 0.5 * shape.radius ? Math.sign(along) : 0;
}

/** Makes a wheel with tyre, rim and spokes. @param {Data} shape @param {import("./index.js").Context} context */
export function wheel(shape, context) {
  const { materials } = context;
  const { radius, width, rim = WHEEL.rim * radius, axis = [0, 1, 0] } = shape;
  const lengths = { rim, side: radius - rim, width };
  const tyre = rubber(WHEEL.parts.find((part) => part.tread !== undefined), lengths, materials);
  const look = (part) => (part.tread === undefined ? materials.get(part.material, { color: part.color, doubleSided: part.double }) : tyre);
  const object = new THREE.Group().add(...composed(WHEEL.parts, lengths, look, outward(shape, axis, context)));
  object.position.fromArray(shape.at ?? [0, 0, 0]);
  const y = unit(axis) ?? [0, 1, 0];
  const x = sideways(y);
  turn(object, fromColumns(x, y, cross(x, y)));
  const road = flattened(tyre);
  object.updateMatrix();
  const [turned, moved] = [new THREE.Matrix3().setFromMatrix4(object.matrix).transpose(), object.position];
  /** @param {number[] | null} plane in axes of the frame: normal, distance from its origin; null: a round tyre */
  const stand = (plane) => {
    if (plane === null) return road.set(0, 0, 0, -1);
    const normal = new THREE.Vector3().fromArray(plane);
    const distance = plane[3] - normal.dot(moved);
    return road.set(...normal.applyMatrix3(turned).toArray(), distance);
  };
  return { object, frame: shape.frame, owned: [tyre, tyre.map].filter(Boolean), stand };
}
