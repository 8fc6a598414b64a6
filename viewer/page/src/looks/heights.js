// Heights of a terrain of patches with different spacings, and surfaces at a point.
import { decodeBase64, floats } from "../bytes.js";
import looks from "../../../looks.json" with { type: "json" };

/** Number of cells of a side of the table that finds the patch at a point. */
const TABLE_SIDE = 64;

/**
 * @typedef {{origin: number[], spacing: number[], shape: number[], heights: Float32Array}} Patch
 *   heights[i * shape[1] + j] is at origin + (i, j) * spacing: rows along x
 */

/** Interpolated heights of a terrain, constant beyond its border. */
export class HeightField {
  /** @param {Data} road an entry of a scene's `roads` of the kind terrain */
  constructor(road) {
    /** @type {Patch[]} */
    this.patches = road.patches.map((patch) => ({ ...patch, heights: floats(patch.heights) }));
    for (const { shape, heights } of this.patches) {
      if (heights.length !== shape[0] * shape[1]) {
        throw new Error(`A patch of the terrain has ${heights.length} heights, not ${shape[0]} x ${shape[1]}.`);
      }
    }
    const ends = this.patches.map(({ origin, spacing, shape }) => origin.map((o, k) => o + spacing[k] * (shape[k] - 1)));
    this.low = [0, 1].map((k) => this.patches.reduce((low, { origin }) => Math.min(low, origin[k]), Infinity));
    this.high = [0, 1].map((k) => ends.reduce((high, end) => Math.max(high, end[k]), -Infinity));
    this.cell = [0, 1].map((k) => (this.high[k] - this.low[k]) / TABLE_SIDE || 1);
    this.near = 1e-6 * Math.max(...this.cell);
    this.table = new Map();
    this.patches.forEach((patch, index) => {
      const [from, to] = [this._cellOf(patch.origin), this._cellOf(ends[index])];
      for (let a = from[0]; a <= to[0]; a++) {
        for (let b = from[1]; b <= to[1]; b++) {
          const key = a * TABLE_SIDE + b;
          if (!this.table.has(key)) this.table.set(key, []);
          this.table.get(key).push({ patch, end: ends[index] });
        }
      }
    });
  }

  _cellOf(at) {
    return at.map((value, k) => this._line(k, value));
  }

  /** Patches at a point, several on their edges. @returns {Patch[]} */
  patchesAt(x, y) {
    return this._candidates(x, y).filter((one) => this._holds(one, x, y)).map(({ patch }) => patch);
  }

  _candidates(x, y) {
    return this.table.get(this._line(0, x) * TABLE_SIDE + this._line(1, y)) ?? [];
  }

  _line(k, value) {
    return Math.min(TABLE_SIDE - 1, Math.max(0, Math.floor((value - this.low[k]) / this.cell[k])));
  }

  _holds({ patch: { origin }, end }, x, y) {
    const { near } = this;
    return x >= origin[0] - near && x <= end[0] + near && y >= origin[1] - near && y <= end[1] + near;
  }

  /** Height of the drawn triangles. @param {number} x @param {number} y */
  at(x, y) {
    const px = Math.min(this.high[0], Math.max(this.low[0], x));
    const py = Math.min(this.high[1], Math.max(this.low[1], y));
    for (const one of this._candidates(px, py)) if (this._holds(one, px, py)) return inPatch(one.patch, px, py);
    return 0;
  }

  /** Least spacing of the patch at a point, m. @param {number} x @param {number} y */
  stepAt(x, y) {
    const [patch] = this.patchesAt(x, y);
    return patch === undefined ? Infinity : Math.min(...patch.spacing);
  }

  /** Slopes along x and y by central differences over the coarsest patch at a point. @returns {number[]} */
  slope(x, y) {
    let [dx, dy] = [1e-3, 1e-3];
    for (const { spacing } of this.patchesAt(x, y)) [dx, dy] = [Math.max(dx, spacing[0]), Math.max(dy, spacing[1])];
    return [(this.at(x + dx, y) - this.at(x - dx, y)) / (2 * dx), (this.at(x, y + dy) - this.at(x, y - dy)) / (2 * dy)];
  }
}

/** Height at a point of a patch, in one of the two triangles of its cell. */
function inPatch({ origin, spacing, shape, heights }, x, y) {
  const u = Math.min(shape[0] - 1, Math.max(0, (x - origin[0]) / spacing[0]));
  const v = Math.min(shape[1] - 1, Math.max(0, (y - origin[1]) / spacing[1]));
  const i = Math.min(Math.floor(u), shape[0] - 2);
  const j = Math.min(Math.floor(v), shape[1] - 2);
  const a = u - i;
  const b = v - j;
  const k = i * shape[1] + j;
  const h01 = heights[k + 1];
  const h10 = heights[k + shape[1]];
  if (a + b <= 1) return heights[k] + a * (h10 - heights[k]) + b * (h01 - heights[k]);
  const h11 = heights[k + shape[1] + 1];
  return h11 + (1 - a) * (h01 - h11) + (1 - b) * (h10 - h11);
}

/** Names of surfaces with their own look. */
export const SURFACES = ["asphalt", "grass", "wet", "gravel", "concrete", "ice", "paint", "dirt"];

/** Index limited to the range of n lines. @param {number} k @param {number} n */
export const heldWithin = (k, n) => Math.min(n - 1, Math.max(0, k));

/**
 * Index of the nearest point of a grid.
 * @param {{origin: number[], spacing: number[], shape: number[]}} grid @param {number} x @param {number} y
 */
export function nearest({ origin, spacing, shape }, x, y) {
  const [i, j] = [x, y].map((value, k) => heldWithin(Math.round((value - origin[k]) / spacing[k]), shape[k]));
  return i * shape[1] + j;
}

/** The raster of the surfaces of a terrain. */
export class SurfaceRaster {
  /** @param {Data | undefined} surface the key `surface` of a terrain; without it: asphalt */
  constructor(surface) {
    this.names = surface?.names ?? ["asphalt"];
    this.origin = surface?.origin ?? [0, 0];
    this.spacing = surface?.spacing ?? [1, 1];
    this.shape = surface?.shape ?? [1, 1];
    this.classes = surface === undefined ? new Uint8Array(1) : decodeBase64(surface.classes);
    if (this.classes.length !== this.shape[0] * this.shape[1]) {
      throw new Error(`The surface of the terrain has ${this.classes.length} classes, not ${this.shape[0]} x ${this.shape[1]}.`);
    }
  }

  /** Name of the surface at a point; beyond the raster that of its border. @param {number} x @param {number} y */
  nameAt(x, y) {
    return this.names[this.classes[nearest(this, x, y)]] ?? "asphalt";
  }
}

/**
 * Shares, 0 to 1, of a film of water on asphalt and of ice, which represent a coefficient of friction.
 * @param {number} factor @returns {[number, number]}
 */
export const slickness = (factor) => [between01((looks.dry - factor) / 0.35), between01((0.5 - factor) / 0.3)];
const between01 = (/** @type {number} */ share) => Math.min(1, Math.max(0, share));

/** Name of the surface that represents a coefficient of friction. @param {number} factor */
export function slickName(factor) {
  const [film, ice] = slickness(factor);
  return ice >= 0.5 ? "ice" : film >= 0.5 ? "wet" : "asphalt";
}

/** Uniform coefficient of friction of a road; by default that of a dry road. @param {Data} road */
export const gripOf = ({ friction, friction_factor: factor }) => (friction ?? looks.dry) * (factor ?? 1);

/** Function that returns the name of the surface at a point of a scene. @param {Data} scene @returns {(x: number, y: number) => string} */
export function surfaceOf(scene) {
  const terrain = (scene.roads ?? []).find(({ kind }) => kind === "terrain");
  if (terrain === undefined) {
    const grid = (scene.roads ?? []).find(({ kind, frictions, axes }) => kind === "grid" && frictions !== undefined && axes === undefined); // without axes it is along x and y
    const same = slickName(gripOf(scene.roads?.[0] ?? {}));
    if (grid === undefined) return () => same;
    const frictions = floats(grid.frictions);
    return (x, y) => slickName(frictions[nearest(grid, x, y)] * (grid.friction_factor ?? 1));
  }
  const raster = new SurfaceRaster(terrain.surface);
  return (x, y) => raster.nameAt(x, y);
}
