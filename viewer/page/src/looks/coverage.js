// How much of each surface lies where, as pictures for the graphics card: soft edges and no shimmer far away.
import { SURFACES } from "./heights.js";
import { smoothTexture } from "./noise.js";

/** The pictures have no more points a side; larger rasters are averaged. */
const MOST = 4096;

/**
 * Shares of the surfaces, 0 to 255: four to a picture, in the order of SURFACES without asphalt, which is the rest.
 * @param {import("./heights.js").SurfaceRaster} raster
 * @param {number} [most] points a side
 * @returns {{width: number, height: number, factor: number, pictures: Uint8Array[]}} rows along x; factor: averaged points
 */
export function shares(raster, most = MOST) {
  const factor = Math.max(1, Math.ceil(Math.max(...raster.shape) / most));
  const [height, width] = raster.shape.map((n) => Math.ceil(n / factor));
  const places = raster.names.map((name) => SURFACES.indexOf(name) - 1);
  const present = new Uint8Array(256);
  for (const value of raster.classes) present[value] = 1;
  const second = places.some((place, k) => place >= 4 && present[k]);
  const pictures = Array.from({ length: second ? 2 : 1 }, () => new Uint8Array(4 * width * height));
  const one = 255 / (factor * factor);
  for (let i = 0; i < height * factor; i++) {
    for (let j = 0; j < width * factor; j++) {
      const from = Math.min(i, raster.shape[0] - 1) * raster.shape[1] + Math.min(j, raster.shape[1] - 1);
      const place = places[raster.classes[from]] ?? -1;
      if (place < 0) continue;
      const to = 4 * (Math.floor(i / factor) * width + Math.floor(j / factor)) + (place & 3);
      const picture = pictures[place >> 2];
      picture[to] = Math.min(255, Math.round(picture[to] + one));
    }
  }
  for (const picture of pictures) for (const step of [1, width]) soften(picture, width, height, step);
  return { width, height, factor, pictures };
}

/** A sixth of each neighbour: where the edge runs across the cells it has no stairs. @param {number} step 1: along a row; else from row to row */
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
 * @param {import("./heights.js").SurfaceRaster} raster
 * @param {number} anisotropy
 * @returns {{textures: import("three").DataTexture[], size: number[], start: number[]}} size: metres of a picture along y and x;
 *   start: metres from the first point of the raster to the corner of the pictures
 */
export function coverage(raster, anisotropy) {
  const { width, height, factor, pictures } = shares(raster);
  const textures = pictures.map((pixels) => smoothTexture(pixels, width, height, anisotropy));
  const [dx, dy] = raster.spacing;
  return { textures, size: [width * factor * dy, height * factor * dx], start: [-0.5 * dy, -0.5 * dx] };
}
