// Makes the texture of a tyre: tread blocks and lines on the side wall, which show its rotation.
import * as THREE from "three";
import { smoothTexture } from "../looks/noise.js";

const [WIDTH, HEIGHT] = [1024, 64];

/**
 * Makes the texture, periodic around the tyre.
 * @param {[number, number]} tread range of the tread in the profile, 0 to 1
 * @returns {THREE.DataTexture}
 */
export function treadTexture(tread) {
  const pixels = new Uint8Array(WIDTH * HEIGHT * 4);
  for (let j = 0; j < HEIGHT; j++) {
    const v = (j + 0.5) / HEIGHT;
    const across = (v - tread[0]) / (tread[1] - tread[0]);
    for (let i = 0; i < WIDTH; i++) {
      const value = across > 0 && across < 1 ? block(i / WIDTH, across) : side(i / WIDTH, v);
      const k = 4 * (j * WIDTH + i);
      pixels.fill(value, k, k + 3);
      pixels[k + 3] = 255;
    }
  }
  return Object.assign(smoothTexture(pixels, WIDTH, HEIGHT, 4), { colorSpace: THREE.SRGBColorSpace, wrapS: THREE.RepeatWrapping });
}

/** Grey value of slanted blocks with a closed rib in the middle. */
function block(u, across) {
  const off = Math.abs(across - 0.5) * 2;
  const slanted = (u * 60 + (across < 0.5 ? off : off + 0.5) * 0.6) % 1;
  return slanted < 0.16 && off > 0.18 ? 70 : 205;
}

/** Grey value of two fine rings and eight marks on each side. */
function side(u, v) {
  const out = Math.abs(v - 0.5) * 2;
  const mark = (u * 8) % 1 < 0.1 && out > 0.66 && out < 0.74;
  return mark ? 255 : Math.abs(out - 0.62) < 0.012 || Math.abs(out - 0.8) < 0.012 ? 235 : 190;
}
