import * as THREE from "three";
import { add, cross, dot, scale, subtract, unit } from "../scene/math.js";
import { roundTubes } from "./tube.js";

/** Normal of a polygon (Newell's method); null for points on a line. @param {number[][]} points */
export function normalOf(points) {
  let sum = [0, 0, 0];
  points.forEach((point, i) => {
    sum = add(sum, cross(subtract(point, points[0]), subtract(points[(i + 1) % points.length], points[0])));
  });
  return unit(sum);
}

/** Triangles of a polygon, by index. @param {number[][]} points @param {number[]} normal */
function trianglesOf(points, normal) {
  const x = unit(subtract(points[1], points[0]));
  const y = cross(normal, x);
  const flat = points.map((point) => new THREE.Vector2(dot(x, point), dot(y, point)));
  return THREE.ShapeUtils.triangulateShape(flat, []);
}

/** A thin plate through points of any frames, with a round edge. @param {Data} shape */
export function plate(shape, { materials }) {
  const { points, thickness } = shape;
  const material = materials.of(shape, "steel");
  const { group, place } = roundTubes(points.length, true, 0.75 * thickness, material);
  const faces = new THREE.Mesh(new THREE.BufferGeometry(), material);
  group.add(faces);
  faces.userData.alone = points.some(([frame]) => frame !== points[0][0]); // it changes its form
  let triangles = null;
  const put = (corners) => {
    place(corners);
    const normal = normalOf(corners);
    faces.visible = normal !== null;
    if (normal === null) return;
    triangles ??= trianglesOf(corners, normal);
    write(faces.geometry, corners, normal, triangles, thickness / 2);
  };
  const frame = points[0][0];
  if (points.every(([other]) => other === frame)) {
    put(points.map(([, local]) => local));
    return { object: group, frame };
  }
  return { object: group, update: (at) => put(points.map(at)) };
}

/** Both faces of the plate. */
function write(geometry, corners, normal, triangles, half) {
  const [positions, normals] = [[], []];
  for (const side of [1, -1]) {
    for (const [a, b, c] of triangles) {
      for (const i of side > 0 ? [a, b, c] : [a, c, b]) {
        positions.push(...add(corners[i], scale(normal, side * half)));
        normals.push(...scale(normal, side));
      }
    }
  }
  set(geometry, "position", positions);
  set(geometry, "normal", normals);
  geometry.computeBoundingSphere();
}

/** Numbers of an attribute; the buffer of the card is kept. */
export function set(geometry, name, numbers, size = 3) {
  const attribute = geometry.getAttribute(name);
  if (attribute?.array.length === numbers.length) {
    attribute.array.set(numbers);
    attribute.needsUpdate = true;
  } else {
    geometry.setAttribute(name, new THREE.BufferAttribute(Float32Array.from(numbers), size));
  }
}
