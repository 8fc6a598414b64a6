// Tubes of a draft: prisms with a least width in the picture, so that they have no gaps.
import * as THREE from "three";
import { atEachPoint } from "../vertex_code.js";

/** Sides of a prism, and least radius of a tube, for a least width of a pixel, pixels. */
const [SIDES, MIN_RADIUS] = [4, 0.75];

const GROW = /* glsl */ `
mat4 stands = modelMatrix;
#ifdef USE_BATCHING
stands = modelMatrix * batchingMatrix;
#endif
float radius = length(mat3(stands) * (normal * thick));
float least = aLeast * (projectionMatrix * viewMatrix * stands * vec4(position, 1.0)).w / projectionMatrix[1][1];
if (radius > 0.0) transformed += normal * thick * max(0.0, least / radius - 1.0);`;

/** `aLeast` of a picture: least radius over half of its height. @param {number} height pixels */
export const leastOf = (height) => (2 * MIN_RADIUS) / height;

/**
 * Widens tubes in a shader; the attribute `thick` is the radius of a point of a tube along its normal, else 0.
 * @param {Data} shader of three.js @param {{value: number}} least see `leastOf`; 0: no widening
 */
export function growing(shader, least) {
  shader.uniforms.aLeast = least;
  atEachPoint(shader, "attribute float thick;\nuniform float aLeast;", GROW);
}

/**
 * Prisms in place of tubes.
 * @param {THREE.Matrix4[]} places of cylinders about y of radius 1 and height 1 @param {number[]} colour
 * @returns {import("./vertex_clustering.js").Surface & {thicks: number[]}}
 */
export function prisms(places, colour) {
  const mesh = { positions: [], normals: [], colours: [], thicks: [], index: [] };
  for (const place of places) {
    const from = mesh.thicks.length;
    for (let k = 0; k < SIDES; k++) {
      const angle = (2 * Math.PI * k) / SIDES;
      const [x, z] = [Math.cos(angle), Math.sin(angle)];
      const ends = [-0.5, 0.5].map((y) => new THREE.Vector3(x, y, z).applyMatrix4(place));
      const outward = ends[0].clone().sub(new THREE.Vector3(0, -0.5, 0).applyMatrix4(place));
      const thick = outward.length();
      for (const end of ends) {
        mesh.positions.push(...end.toArray());
        mesh.normals.push(...outward.toArray().map((value) => value / thick));
        mesh.colours.push(...colour);
        mesh.thicks.push(thick);
      }
      const [a, b] = [from + 2 * k, from + 2 * ((k + 1) % SIDES)];
      mesh.index.push(a, a + 1, b, b, a + 1, b + 1);
    }
  }
  return mesh;
}
