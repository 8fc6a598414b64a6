// Thin plates.
import * as THREE from "three";
import { across, add, cross, dot, fromColumns, length, subtract, unit } from "../scene/math.js";
import { setNumbers, turn } from "./place.js";
import { roundTubes } from "./tube.js";

/** Normal of a polygon (Newell's method); null if the points are on a line. @param {number[][]} points */
function normalOf(points) {
  let sum = [0, 0, 0];
  points.forEach((point, i) => {
    sum = add(sum, cross(subtract(point, points[0]), subtract(points[(i + 1) % points.length], points[0])));
  });
  return unit(sum);
}

/** Makes a plate through points of any frames, with a round edge. @param {Data} shape @param {import("./index.js").Context} context */
export function plate(shape, { materials, rigid = false }) {
  const { points, thickness } = shape;
  const material = materials.forShape(shape, "steel");
  const { group, place } = roundTubes(points.length, true, 0.75 * thickness, material);
  const faces = new THREE.Mesh(new THREE.BufferGeometry(), material);
  group.add(faces);
  faces.userData.alone = points.some(([frame]) => frame !== points[0][0]); // its form changes
  let [triangles, drawn] = [null, null];
  const setCorners = (corners) => {
    place(corners);
    const normal = normalOf(corners);
    faces.visible = normal !== null;
    if (normal === null) return;
    const along = unit(subtract(corners[1], corners[0])) ?? across(normal);
    const axes = [along, cross(normal, along), normal];
    const flat = corners.map((corner) => axes.map((axis) => dot(axis, subtract(corner, corners[0]))));
    faces.position.fromArray(corners[0]);
    turn(faces, fromColumns(...axes));
    if (rigid && drawn !== null) {
      const changes = flat.map((corner, k) => length(subtract(corner, drawn[k])));
      faces.userData.bent = Math.max(faces.userData.bent ?? 0, ...changes);
      return;
    }
    const corner = flat.map(([x, y]) => new THREE.Vector2(x, y));
    triangles ??= THREE.ShapeUtils.triangulateShape(corner, []);
    drawn = flat;
    write(faces.geometry, flat, triangles, thickness / 2);
  };
  const frame = points[0][0];
  if (points.every(([other]) => other === frame)) {
    setCorners(points.map(([, local]) => local));
    return { object: group, frame };
  }
  return { object: group, update: (at) => setCorners(points.map(at)) };
}

/** Writes both faces of the plate, normal to z. */
function write(geometry, corners, triangles, half) {
  const [positions, normals] = [[], []];
  for (const side of [1, -1]) {
    for (const [a, b, c] of triangles) {
      for (const i of side > 0 ? [a, b, c] : [a, c, b]) {
        positions.push(...add(corners[i], [0, 0, side * half]));
        normals.push(0, 0, side);
      }
    }
  }
  setNumbers(geometry, "position", positions);
  setNumbers(geometry, "normal", normals);
  geometry.computeBoundingSphere();
}
