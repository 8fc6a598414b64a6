import * as THREE from "three";
import { add, length, scale, subtract, unit } from "../scene/math.js";
import { bevelled } from "./cylinder.js";
import { stretch } from "./place.js";

/** Length of the tube and of the rod beside that of the damper as drawn: they overlap by a fifth. */
const SHARE = 0.6;

/** A telescopic damper between two points: a tube at the first end, a rod at the second. @param {Data} shape */
export function damper(shape, { materials, frames }) {
  const { radius, ends } = shape;
  const unitBody = new THREE.LatheGeometry(bevelled(1, 1), 20);
  const body = new THREE.Mesh(unitBody, materials.of(shape, "dark_paint"));
  const collar = new THREE.Mesh(unitBody, materials.named("steel"));
  const rod = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 20), materials.named("chrome"));
  const eye = new THREE.SphereGeometry(0.75 * radius, 12, 8);
  const eyes = [0, 1].map(() => new THREE.Mesh(eye, materials.named("steel")));
  const object = new THREE.Group().add(body, collar, rod, ...eyes);
  const drawn = ends.map(([frame, local]) => frames.point(frame, local));
  let free = drawn.includes(null) ? null : length(subtract(drawn[1], drawn[0]));
  const update = (at) => {
    const [from, to] = ends.map(at);
    const along = unit(subtract(to, from));
    object.visible = along !== null;
    if (along === null) return;
    const now = length(subtract(to, from));
    free ??= now;
    const part = Math.min(SHARE * free, 0.97 * now);
    const top = add(from, scale(along, part));
    stretch(body, add(from, scale(along, Math.min(radius, part / 4))), top, radius);
    stretch(collar, subtract(top, scale(along, Math.min(0.6 * radius, part / 8))), add(top, scale(along, 0.02 * radius)), 1.1 * radius);
    stretch(rod, subtract(to, scale(along, part)), to, 0.42 * radius);
    eyes.forEach((mesh, i) => mesh.position.fromArray([from, to][i]));
  };
  return { object, update };
}
