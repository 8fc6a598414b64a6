// Coil springs.
import * as THREE from "three";
import shapes from "../../../shapes.json" with { type: "json" };
import { across, add, cross, dot, fromColumns, length, perpendicular, rotate, scale, subtract, unit } from "../scene/math.js";
import { coilSurface, coilTriangles } from "./coil.js";
import { setNumbers, stretch, turn } from "./place.js";

/** Defaults of shapes, and dimensions of the seats as shares. */
const DEFAULTS = shapes.spring;

/** Makes a coil spring between two points; the thickness of its wire is constant, unless shapes are rigid. @param {Data} shape */
export function spring(shape, { materials, frames, rigid = false }) {
  const { radius, wire = DEFAULTS.wire * radius, coils = DEFAULTS.coils, seat: begin = 0, ends } = shape;
  const material = materials.forShape({ color: DEFAULTS.color, ...shape }, "paint");
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(coilTriangles(coils));
  const coil = new THREE.Mesh(geometry, material);
  Object.assign(coil.userData, { alone: true, round: true }); // its form changes
  coil.userData.coarse = coilTriangles(coils, 2); // triangles for drafts
  const seat = new THREE.CylinderGeometry(1, 1, 1, 24);
  const seats = [0, 1].map(() => new THREE.Mesh(seat, materials.get("dark_paint")));
  const object = new THREE.Group().add(coil, ...seats);
  let drawnHeight = 0;
  const update = (at) => {
    const [end, to] = ends.map(at);
    const z = unit(subtract(to, end));
    object.visible = z !== null;
    if (z === null) return;
    const distance = length(subtract(to, end));
    const from = add(end, scale(z, Math.min(begin, DEFAULTS.most * distance)));
    // The start of the wire is fixed on the body of the first end.
    const body = frames.pose(ends[0][0]).rotation;
    const candidates = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => rotate(body, axis)); // prettier-ignore
    const best = candidates.reduce((a, b) => (Math.abs(dot(a, z)) <= Math.abs(dot(b, z)) ? a : b));
    const x = perpendicular(best, z) ?? across(z);
    const height = length(subtract(to, from));
    if (!rigid || drawnHeight === 0) {
      const { positions, normals } = coilSurface({ coils, radius, wire }, height);
      setNumbers(geometry, "position", positions);
      setNumbers(geometry, "normal", normals);
      geometry.computeBoundingSphere();
      drawnHeight = height;
    }
    coil.position.fromArray(from);
    turn(coil, fromColumns(cross(z, x), z, x));
    coil.scale.y = height / drawnHeight;
    const rim = DEFAULTS.rim * (radius + wire / 2);
    stretch(seats[0], subtract(from, scale(z, DEFAULTS.plate * wire)), from, rim);
    stretch(seats[1], to, add(to, scale(z, DEFAULTS.plate * wire)), rim);
  };
  return { object, update };
}
