// Telescopic dampers.
import * as THREE from "three";
import shapes from "../../../shapes.json" with { type: "json" };
import { add, length, scale, subtract, unit } from "../scene/math.js";
import { bevelled } from "./cylinder.js";
import { stretch } from "./place.js";

/** Dimensions as shares of the radius and of the length as drawn. */
const { share, most, foot, rod: thin, eye: ball, collar: wide, below, above } = shapes.damper;

/** Makes a damper between two points, with the tube at the first end and the rod at the second. @param {Data} shape */
export function damper(shape, { materials, frames }) {
  const { radius, ends } = shape;
  const unitBody = new THREE.LatheGeometry(bevelled(1, 1), 20);
  const body = new THREE.Mesh(unitBody, materials.forShape(shape, "dark_paint"));
  const collar = new THREE.Mesh(unitBody, materials.get("steel"));
  const rod = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 20), materials.get("chrome"));
  const eye = new THREE.SphereGeometry(ball * radius, 12, 8);
  const eyes = [0, 1].map(() => new THREE.Mesh(eye, materials.get("steel")));
  const object = new THREE.Group().add(body, collar, rod, ...eyes);
  const drawn = ends.map(([frame, local]) => frames.point(frame, local));
  let drawnLength = drawn.includes(null) ? null : length(subtract(drawn[1], drawn[0]));
  const update = (at) => {
    const [from, to] = ends.map(at);
    const along = unit(subtract(to, from));
    object.visible = along !== null;
    if (along === null) return;
    const distance = length(subtract(to, from));
    drawnLength ??= distance;
    const tubeLength = Math.min(share * drawnLength, most * distance);
    const top = add(from, scale(along, tubeLength));
    stretch(body, add(from, scale(along, Math.min(radius, foot * tubeLength))), top, radius);
    stretch(collar, subtract(top, scale(along, Math.min(below[0] * radius, below[1] * tubeLength))), add(top, scale(along, above * radius)), wide * radius);
    stretch(rod, subtract(to, scale(along, tubeLength)), to, thin * radius);
    eyes.forEach((mesh, i) => mesh.position.fromArray([from, to][i]));
  };
  return { object, update };
}
