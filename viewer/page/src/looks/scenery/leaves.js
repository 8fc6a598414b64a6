// Draws the texture of a twig with leaves.
import * as THREE from "three";
import { smoothTexture } from "../noise.js";
import { randomNumbers } from "../../common/random.js";

/** Side of the texture, pixels. */
export const SIDE = 128;

/** Makes the texture. @returns {THREE.DataTexture} */
export function leafTexture() {
  const pixels = new Uint8Array(SIDE * SIDE * 4);
  const next = randomNumbers(4711);
  // The transparent background has the colour of leaves, so that their edges keep it.
  for (let k = 0; k < pixels.length; k += 4) pixels.set([110, 128, 60, 0], k);
  for (let leaf = 0; leaf < 150; leaf++) {
    const [angle, distance] = [2 * Math.PI * next(), Math.sqrt(next())];
    const middle = [0.5 * SIDE + 0.4 * SIDE * distance * Math.cos(angle), 0.5 * SIDE + 0.4 * SIDE * distance * Math.sin(angle)];
    drawLeaf(pixels, middle, 4 + 5 * next(), 2 * Math.PI * next(), 0.62 + 0.38 * next(), next());
  }
  return Object.assign(smoothTexture(pixels, SIDE, SIDE, 1), { colorSpace: THREE.SRGBColorSpace });
}

/** Draws a leaf. @param {Uint8Array} pixels @param {number[]} middle */
function drawLeaf(pixels, [mx, my], length, turn, shade, yellow) {
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  for (let dy = -9; dy <= 9; dy++) {
    for (let dx = -9; dx <= 9; dx++) {
      const [u, v] = [(c * dx + s * dy) / length, (c * dy - s * dx) / (0.5 * length)];
      const [x, y] = [Math.round(mx + dx), Math.round(my + dy)];
      if (u * u + v * v > 1 || x < 0 || y < 0 || x >= SIDE || y >= SIDE) continue;
      const lit = shade * (1 - 0.2 * Math.abs(v));
      pixels.set([lit * (130 + 50 * yellow), lit * 165, lit * 62, 255], 4 * (y * SIDE + x));
    }
  }
}
