// Makes geometries of cones and posts of height 1, for instances.
import looks from "../../../../looks.json" with { type: "json" };
import { Triangles } from "./triangles.js";

/** Linear colours. @type {{cones: Record<string, number[]>, white: number[]}} */
const { cones: CONES, white: WHITE } = looks.things;

/**
 * Adds a surface of revolution of rings, with a colour between two rings.
 * @param {Triangles} triangles @param {{radius: number, z: number, colour: number[]}[]} rings @param {number} sides
 */
export function turned(triangles, rings, sides) {
  for (let i = 0; i + 1 < rings.length; i++) {
    const [low, high] = [rings[i], rings[i + 1]];
    for (let k = 0; k < sides; k++) {
      const [a, b] = [k, k + 1].map((n) => (2 * Math.PI * n) / sides);
      const corner = (angle, { radius, z }) => [radius * Math.cos(angle), radius * Math.sin(angle), z];
      triangles.quad([corner(a, low), corner(b, low), corner(b, high), corner(a, high)], low.colour);
    }
  }
}

/** Makes a cone. @param {string} colour orange, yellow or blue @param {boolean} [coarse] with four sides, open at the top */
export function coneGeometry(colour = "orange", coarse = false) {
  const triangles = new Triangles();
  const paint = CONES[colour] ?? CONES.orange;
  triangles.box([0, 0, 0], [0.56, 0.56, 0.05], 0, paint.map((value) => 0.6 * value));
  const levels = [0.05, 0.38, 0.58, 0.72, 0.86, 1];
  const rings = levels.map((z, k) => ({ z, radius: 0.21 - 0.165 * z, colour: k % 2 === 1 ? WHITE : paint }));
  if (!coarse) rings.push({ z: 1, radius: 0.001, colour: paint });
  turned(triangles, rings, coarse ? 4 : 12);
  return triangles.geometry();
}

/** A white post with a black band and a reflector. @param {boolean} [coarse] without the reflector */
export function postGeometry(coarse = false) {
  const triangles = new Triangles();
  triangles.box([0, 0, 0], [0.1, 0.12, 0.72], 0, WHITE);
  triangles.box([0, 0, 0.72], [0.1, 0.12, 0.2], 0.0, [0.02, 0.02, 0.02]);
  triangles.box([0, 0, 0.92], [0.1, 0.12, 0.08], 0, WHITE);
  if (!coarse) triangles.box([0, 0, 0.76], [0.112, 0.05, 0.12], 0, [0.85, 0.5, 0.08]);
  return triangles.geometry();
}
