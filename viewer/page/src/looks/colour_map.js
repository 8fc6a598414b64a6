// A perceptually uniform colour map: viridis (Smith, van der Walt, Firing; public domain), every fifth of its 256 colours.
import * as THREE from "three";
import looks from "../../../looks.json" with { type: "json" };

const STOPS = looks.stress;

/** Colour of a level, three numbers from 0 to 255. @param {number} level 0 to 1, limited */
export function colourAt(level) {
  const at = Math.min(Math.max(level, 0), 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(at), STOPS.length - 2);
  const parts = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
  const [low, high] = [parts(STOPS[i]), parts(STOPS[i + 1])];
  return low.map((c, k) => c + (at - i) * (high[k] - c));
}

/** The map as a CSS gradient. @param {string} [direction] */
export const gradient = (direction = "to right") => `linear-gradient(${direction}, ${STOPS.join(", ")})`;

/** The map as a texture of one row. */
export function colourTexture() {
  const pixels = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; i++) pixels.set([...colourAt(i / 255).map(Math.round), 255], 4 * i);
  const texture = new THREE.DataTexture(pixels, 256, 1);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
