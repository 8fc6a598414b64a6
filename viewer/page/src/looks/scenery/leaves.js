// Draws the texture of a twig with leaves.
import * as THREE from "three";
import { smoothTexture } from "../noise.js";
import { randomNumbers } from "../../common/random.js";

/** Side of the texture, pixels. */
export const SIDE = 128;

const SEED = 4711; // any: the same leaves each time
const LEAVES = 150;
/** Radius of the twig, of the side of the texture. */
const RADIUS = 0.4;
/** Shortest and longest half length of a leaf, pixels. */
const [SHORTEST, LONGEST] = [4, 9];
const DARKEST = 0.62; // brightness, 0 to 1

/** Makes the texture. @returns {THREE.DataTexture} */
export function leafTexture() {
  const pixels = new Uint8Array(SIDE * SIDE * 4);
  const next = randomNumbers(SEED);
  // The transparent background has the colour of leaves, so that their edges keep it.
  for (let k = 0; k < pixels.length; k += 4) pixels.set([110, 128, 60, 0], k);
  for (let leaf = 0; leaf < LEAVES; leaf++) {
    const [angle, distance] = [2 * Math.PI * next(), Math.sqrt(next())];
    const middle = [Math.cos(angle), Math.sin(angle)].map((part) => 0.5 * SIDE + RADIUS * SIDE * distance * part);
    const halfLength = SHORTEST + (LONGEST - SHORTEST) * next();
    drawLeaf(pixels, middle, halfLength, 2 * Math.PI * next(), DARKEST + (1 - DARKEST) * next(), next());
  }
  return Object.assign(smoothTexture(pixels, SIDE, SIDE, 1), { colorSpace: THREE.SRGBColorSpace });
}

/** Draws a leaf. @param {Uint8Array} pixels @param {number[]} middle pixels @param {number} halfLength pixels; half the width is half of it
 * @param {number} turn rad @param {number} shade brightness, 0 to 1 @param {number} yellow 0 for green to 1 for yellow */
function drawLeaf(pixels, [mx, my], halfLength, turn, shade, yellow) {
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  for (let dy = -LONGEST; dy <= LONGEST; dy++) {
    for (let dx = -LONGEST; dx <= LONGEST; dx++) {
      const [u, v] = [(c * dx + s * dy) / halfLength, (c * dy - s * dx) / (0.5 * halfLength)];
      const [x, y] = [Math.round(mx + dx), Math.round(my + dy)];
      if (u * u + v * v > 1 || x < 0 || y < 0 || x >= SIDE || y >= SIDE) continue;
      const lit = shade * (1 - 0.2 * Math.abs(v));
      pixels.set([lit * (130 + 50 * yellow), lit * 165, lit * 62, 255], 4 * (y * SIDE + x));
    }
  }
}
