import * as THREE from "three";
import shapes from "../../../shapes.json" with { type: "json" };
import { across, add, cross, dot, fromColumns, length, rotate, scale, subtract, unit } from "../scene/math.js";
import { coilSurface, coilTriangles } from "./coil.js";
import { set } from "./plate.js";
import { stretch, turn } from "./place.js";

/** Where the scene says nothing, and shares: of the way to the seat, of the seats' radius and thickness. */
const USUAL = shapes.spring;

/** A coil spring between two points; its wire keeps its thickness when it is compressed, if its form may change. @param {Data} shape */
export function spring(shape, { materials, frames, rigid = false }) {
  const { radius, wire = USUAL.wire * radius, coils = USUAL.coils, seat: begin = 0, ends } = shape;
  const material = materials.of({ color: USUAL.color, ...shape }, "paint");
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(coilTriangles(coils));
  const wound = new THREE.Mesh(geometry, material);
  Object.assign(wound.userData, { alone: true, round: true }); // it changes its form
  wound.userData.coarse = coilTriangles(coils, 2); // of a draft
  const seat = new THREE.CylinderGeometry(1, 1, 1, 24);
  const seats = [0, 1].map(() => new THREE.Mesh(seat, materials.named("dark_paint")));
  const object = new THREE.Group().add(wound, ...seats);
  let drawn = 0;
  const update = (at) => {
    const [end, to] = ends.map(at);
    const z = unit(subtract(to, end));
    object.visible = z !== null;
    if (z === null) return;
    const whole = length(subtract(to, end));
    const from = add(end, scale(z, Math.min(begin, USUAL.most * whole)));
    // The start of the wire keeps its place on the body of the first end.
    const body = frames.pose(ends[0][0]).rotation;
    const candidates = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => rotate(body, axis)); // prettier-ignore
    const best = candidates.reduce((a, b) => (Math.abs(dot(a, z)) <= Math.abs(dot(b, z)) ? a : b));
    const x = unit(subtract(best, scale(z, dot(best, z)))) ?? across(z);
    const height = length(subtract(to, from));
    if (!rigid || drawn === 0) {
      const { positions, normals } = coilSurface({ coils, radius, wire }, height);
      set(geometry, "position", positions);
      set(geometry, "normal", normals);
      geometry.computeBoundingSphere();
      drawn = height;
    }
    wound.position.fromArray(from);
    turn(wound, fromColumns(cross(z, x), z, x));
    wound.scale.y = height / drawn;
    const rim = USUAL.rim * (radius + wire / 2);
    stretch(seats[0], subtract(from, scale(z, USUAL.plate * wire)), from, rim);
    stretch(seats[1], to, add(to, scale(z, USUAL.plate * wire)), rim);
  };
  return { object, update };
}
