// Makes geometries of cones and posts of height 1, for instances.
import looks from "../../../../looks.json" with { type: "json" };
import { Triangles } from "./triangles.js";

/** Linear colours. @type {{cones: Record<string, number[]>, white: number[]}} */
const { cones: CONES, white: WHITE } = looks.things;
/** Base of a cone: side and height; share of the light of its paint. */
const [BASE, BASE_HEIGHT, BASE_SHADE] = [0.56, 0.05, 0.6];
/** Heights at which the colour of a cone changes. */
const BANDS = [BASE_HEIGHT, 0.38, 0.58, 0.72, 0.86, 1];
/** Radius of a cone at height 0, and by how much less at height 1. */
const [CONE_RADIUS, TAPER] = [0.21, 0.165];
/** Depth and width of a post; heights at which its black band begins and ends. */
const [POST_DEPTH, POST_WIDTH, BAND_LOW, BAND_HIGH] = [0.1, 0.12, 0.72, 0.92];
const [BLACK, AMBER] = [[0.02, 0.02, 0.02], [0.85, 0.5, 0.08]]; // prettier-ignore

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
  triangles.box([0, 0, 0], [BASE, BASE, BASE_HEIGHT], 0, paint.map((value) => BASE_SHADE * value));
  const rings = BANDS.map((z, k) => ({ z, radius: CONE_RADIUS - TAPER * z, colour: k % 2 === 1 ? WHITE : paint }));
  if (!coarse) rings.push({ z: 1, radius: 0.001, colour: paint });
  turned(triangles, rings, coarse ? 4 : 12);
  return triangles.geometry();
}

/** A white post with a black band and a reflector. @param {boolean} [coarse] without the reflector */
export function postGeometry(coarse = false) {
  const triangles = new Triangles();
  triangles.box([0, 0, 0], [POST_DEPTH, POST_WIDTH, BAND_LOW], 0, WHITE);
  triangles.box([0, 0, BAND_LOW], [POST_DEPTH, POST_WIDTH, 0.2], 0, BLACK);
  triangles.box([0, 0, BAND_HIGH], [POST_DEPTH, POST_WIDTH, 0.08], 0, WHITE);
  if (!coarse) triangles.box([0, 0, 0.76], [0.112, 0.05, 0.12], 0, AMBER);
  return triangles.geometry();
}
