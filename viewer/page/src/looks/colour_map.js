// A perceptually uniform colour map: viridis (Smith, van der Walt, Firing; public domain), at 17 places.
import * as THREE from "three";

const STOPS =
  "440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30 d8e219 fde725".split(" ");

/** Colour of a level: three numbers 0 to 255. @param {number} level 0 to 1; outside, the end's colour */
export function colourAt(level) {
  const at = Math.min(Math.max(level, 0), 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(at), STOPS.length - 2);
  const parts = (text) => [0, 2, 4].map((k) => parseInt(text.slice(k, k + 2), 16));
  const [low, high] = [parts(STOPS[i]), parts(STOPS[i + 1])];
  return low.map((c, k) => c + (at - i) * (high[k] - c));
}

/** The map as a CSS gradient. @param {string} [direction] */
export const gradient = (direction = "to right") => `linear-gradient(${direction}, ${STOPS.map((stop) => `#${stop}`).join(", ")})`;

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
