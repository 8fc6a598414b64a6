// A tile of noise that repeats without a seam, made once by code: four scales in the four channels.
import * as THREE from "three";

const SIZE = 256;

/** Numbers between 0 and 1 that look like chance, the same on every machine. @param {number} n */
function hash(n) {
  let x = Math.imul(n ^ 0x9e3779b9, 0x85ebca6b);
  x = Math.imul(x ^ (x >>> 13), 0xc2b2ae35);
  return ((x ^ (x >>> 16)) >>> 0) / 4294967296;
}

const smooth = (t) => t * t * (3 - 2 * t);

/** Value noise with `cells` cells a side, repeating. */
function valueNoise(x, y, cells, seed) {
  const [i, j] = [Math.floor(x * cells), Math.floor(y * cells)];
  const [u, v] = [smooth(x * cells - i), smooth(y * cells - j)];
  const at = (a, b) => hash(seed + (a % cells) + 1024 * (b % cells));
  const low = at(i, j) * (1 - u) + at(i + 1, j) * u;
  return low * (1 - v) + (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
}

/** Sum of octaves, 0 to 1. */
export function fractalNoise(x, y, cells, octaves, seed) {
  let [sum, weight, total] = [0, 1, 0];
  for (let k = 0; k < octaves; k++) {
    sum += weight * valueNoise(x, y, cells << k, seed + 7919 * k);
    total += weight;
    weight *= 0.55;
  }
  return sum / total;
}

/** red: grain, green: patches, blue: clouds of tone, alpha: fine specks. @returns {THREE.DataTexture} */
export function noiseTexture(anisotropy = 1) {
  const pixels = new Uint8Array(SIZE * SIZE * 4);
  for (let j = 0; j < SIZE; j++) {
    for (let i = 0; i < SIZE; i++) {
      const [x, y] = [i / SIZE, j / SIZE];
      const k = 4 * (j * SIZE + i);
      pixels[k] = 255 * (0.55 * hash(11 + i + SIZE * j) + 0.45 * valueNoise(x, y, 96, 5));
      pixels[k + 1] = 255 * fractalNoise(x, y, 8, 4, 101);
      pixels[k + 2] = 255 * fractalNoise(x, y, 3, 5, 211);
      pixels[k + 3] = 255 * Math.min(1, Math.max(0, 6 * (valueNoise(x, y, 128, 307) - 0.82)));
    }
  }
  const texture = smoothTexture(pixels, SIZE, SIZE, anisotropy);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  return texture;
}

/** Pixels that do not shimmer from afar. @param {Uint8Array} pixels @param {number} width @param {number} height @param {number} anisotropy */
export function smoothTexture(pixels, width, height, anisotropy) {
  const texture = new THREE.DataTexture(pixels, width, height);
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = anisotropy;
  texture.needsUpdate = true;
  return texture;
}
