// Makes a texture with the share of each surface at each point of the ground.
import { SURFACES } from "./heights.js";
import { smoothTexture } from "./noise.js";

/** Largest number of points of a side of the texture; larger rasters are averaged. */
const MAX_SIDE = 4096;
const LAST_SURFACE = SURFACES.length - 1;

/**
 * Shares of the surfaces. Two surfaces share a channel: 128 + 127 is all of one, and half as much below 128 is all of the
 * other: the first and the last of SURFACES, the second and the last but one, ... Such pairs are seldom adjacent, and the
 * mean of both, as in mipmaps, differs from the 128 of neither.
 * @param {import("./heights.js").SurfaceRaster} raster
 * @param {number} [most] largest number of points of a side
 * @returns {{width: number, height: number, factor: number, pixels: Uint8Array}} rows along x; factor: number of averaged points in each direction
 */
export function shares(raster, most = MAX_SIDE) {
  const factor = Math.max(1, Math.ceil(Math.max(...raster.shape) / most));
  const [height, width] = raster.shape.map((n) => Math.ceil(n / factor));
  const { shape, classes } = raster;
  const one = 127 / (factor * factor);
  const places = Array.from({ length: 256 }, (_, k) => Math.max(0, SURFACES.indexOf(raster.names[k])));
  const channels = Uint8Array.from(places, (place) => Math.min(place, LAST_SURFACE - place));
  const amounts = Float32Array.from(places, (place) => (2 * place < LAST_SURFACE ? one : -0.5 * one));
  const sums = new Float32Array(4 * width * height).fill(128.5);
  for (let i = 0; i < height * factor; i++) {
    const row = Math.min(i, shape[0] - 1) * shape[1];
    const to = 4 * width * Math.floor(i / factor);
    for (let j = 0; j < width * factor; j++) {
      const kind = classes[row + Math.min(j, shape[1] - 1)];
      sums[to + 4 * Math.floor(j / factor) + channels[kind]] += amounts[kind];
    }
  }
  const pixels = new Uint8Array(sums);
  for (const step of [1, width]) soften(pixels, width, height, step);
  return { width, height, factor, pixels };
}

/** Smooths along one direction, which avoids stairs at oblique edges. @param {number} step 1: along rows; else distance of rows */
function soften(picture, width, height, step) {
  const [along, lines] = step === 1 ? [width, height] : [height, width];
  const next = step === 1 ? width : 1;
  for (let line = 0; line < lines; line++) {
    for (let channel = 0; channel < 4; channel++) {
      const start = 4 * line * next + channel;
      let before = picture[start];
      for (let k = 0; k < along; k++) {
        const at = start + 4 * step * k;
        const here = picture[at];
        const after = k + 1 < along ? picture[at + 4 * step] : here;
        picture[at] = (before + 4 * here + after) / 6 + 0.5;
        before = here;
      }
    }
  }
}

/**
 * Texture of the shares of the surfaces.
 * @param {import("./heights.js").SurfaceRaster} raster
 * @param {number} anisotropy
 * @returns {{texture: import("three").DataTexture, size: number[], start: number[]}} size: of the texture along y and
 *   x, m; start: from the first point of the raster to the corner of the texture, m
 */
export function coverage(raster, anisotropy) {
  const { width, height, factor, pixels } = shares(raster);
  const texture = smoothTexture(pixels, width, height, anisotropy);
  const [dx, dy] = raster.spacing;
  return { texture, size: [width * factor * dy, height * factor * dx], start: [-0.5 * dy, -0.5 * dx] };
}
