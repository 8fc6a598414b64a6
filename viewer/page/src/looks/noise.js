// Makes seamless textures of noise at several scales.
import * as THREE from "three";

const SIZE = 256;

/** Pseudo-random number from 0 to below 1 of an integer, the same on every machine. @param {number} n */
function hash(n) {
  let x = Math.imul(n ^ 0x9e3779b9, 0x85ebca6b);
  x = Math.imul(x ^ (x >>> 13), 0xc2b2ae35);
  return ((x ^ (x >>> 16)) >>> 0) / 4294967296;
}

const smooth = (t) => t * t * (3 - 2 * t);

/** Periodic value noise with `cells` cells in each direction. */
function valueNoise(x, y, cells, seed) {
  const [i, j] = [Math.floor(x * cells), Math.floor(y * cells)];
  const [u, v] = [smooth(x * cells - i), smooth(y * cells - j)];
  const at = (a, b) => hash(seed + (a % cells) + 1024 * (b % cells));
  const low = at(i, j) * (1 - u) + at(i + 1, j) * u;
  return low * (1 - v) + (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
}

/** Sum of octaves, 0 to 1. */
function fractalNoise(x, y, cells, octaves, seed) {
  let [sum, weight, total] = [0, 1, 0];
  for (let k = 0; k < octaves; k++) {
    sum += weight * valueNoise(x, y, cells << k, seed + 7919 * k);
    total += weight;
    weight *= 0.55;
  }
  return sum / total;
}

/** Seed of the tones; octaves of the same cell size have the same seed at all levels. */
const SEED = 101;

/**
 * A level of patches whose mipmaps have constant contrast: cells of 4 to 32 points at each level, so that they cover a few
 * pixels at any distance.
 * @param {number} n points of a side, a power of two @returns {Uint8Array}
 */
function tonesOf(n) {
  const cells = Math.max(1, n / 32);
  const octaves = Math.max(1, Math.log2(n / 4 / cells) + 1);
  const at = (k) => fractalNoise((k % n) / n, Math.floor(k / n) / n, cells, octaves, SEED + 7919 * Math.log2(cells));
  return Uint8Array.from({ length: n * n }, (_, k) => 255 * at(k));
}

/** Texture of patches for drafts, which have no other layers. @returns {THREE.DataTexture} */
export function tonesTexture() {
  const levels = Array.from({ length: Math.log2(SIZE) + 1 }, (_, k) => SIZE >> k);
  const texture = new THREE.DataTexture(null, SIZE, SIZE, THREE.RedFormat);
  texture.mipmaps = levels.map((n) => ({ data: tonesOf(n), width: n, height: n }));
  return repeated(sampled(texture, 1));
}

/** Texture with grain in red, patches in green, large tones in blue, fine specks in alpha. @returns {THREE.DataTexture} */
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
  return repeated(smoothTexture(pixels, SIZE, SIZE, anisotropy));
}

/** Texture with mipmaps, which avoid flicker at a distance. @param {Uint8Array} pixels @param {number} width @param {number} height @param {number} anisotropy */
export function smoothTexture(pixels, width, height, anisotropy) {
  const texture = new THREE.DataTexture(pixels, width, height);
  texture.generateMipmaps = true;
  return sampled(texture, anisotropy);
}

/** Sets filters of a texture. @param {THREE.DataTexture} texture @param {number} anisotropy */
function sampled(texture, anisotropy) {
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.anisotropy = anisotropy;
  texture.needsUpdate = true;
  return texture;
}

/** Copy of a texture that uses the nearest mipmap, without blending. @param {THREE.Texture} texture */
export function oneLevel(texture) {
  const copy = texture.clone();
  copy.minFilter = THREE.LinearMipmapNearestFilter;
  copy.needsUpdate = true;
  return copy;
}

/** Makes a texture periodic. @param {THREE.DataTexture} texture */
function repeated(texture) {
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  return texture;
}
