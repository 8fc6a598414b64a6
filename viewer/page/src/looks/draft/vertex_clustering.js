// Reduces triangles by merging the points in each cell of a lattice.

/** @typedef {{positions: number[], normals: number[], colours: number[], index: number[]}} Surface */

/** Number of lattice indices of an axis; three indices make one integer. */
const INDEX_COUNT = 2 ** 17;
/** Ratio of cell sizes of a lattice and the next finer one. */
const CELL_RATIO = 1.3;

/** Index of the nearest of six directions to a normal, which separates the two sides of a sheet. */
function side(normals, k) {
  let axis = 0;
  for (const other of [1, 2]) if (Math.abs(normals[3 * k + other]) > Math.abs(normals[3 * k + axis])) axis = other;
  return 2 * axis + (normals[3 * k + axis] < 0 ? 1 : 0);
}

/** Function that numbers keys from 0 in the order of their first use. */
function numbering() {
  const known = new Map();
  return (key) => {
    const number = known.get(key);
    if (number !== undefined) return number;
    known.set(key, known.size);
    return known.size - 1;
  };
}

/** Colour and side of each point as one number; points of different kinds are not merged. @param {Surface} surface */
function kindsOf({ normals, colours }) {
  const tints = numbering();
  let [tint, last] = [0, -1]; // consecutive points mostly have the same colour
  return Uint32Array.from({ length: normals.length / 3 }, (_, k) => {
    if (last < 0 || [0, 1, 2].some((i) => colours[3 * k + i] !== colours[3 * last + i])) tint = tints(`${colours[3 * k]},${colours[3 * k + 1]},${colours[3 * k + 2]}`);
    last = k;
    return 6 * tint + side(normals, k);
  });
}

/**
 * Cells and merged points of the points of a surface, and the remaining triangles.
 * @param {Surface} surface @param {Uint32Array} kinds of its points @param {number} cell side of a cell, m
 */
function latticed({ positions, index }, kinds, cell) {
  const [cells, points] = [numbering(), numbering()];
  const [cellOf, pointOf] = [new Uint32Array(kinds.length), new Uint32Array(kinds.length)];
  const line = (k) => Math.round(positions[k] / cell) + INDEX_COUNT / 2;
  let many = 0;
  kinds.forEach((kind, k) => {
    cellOf[k] = cells((line(3 * k) * INDEX_COUNT + line(3 * k + 1)) * INDEX_COUNT + line(3 * k + 2));
    pointOf[k] = points(kind * kinds.length + cellOf[k]);
    many = Math.max(many, pointOf[k] + 1);
  });
  const seen = new Set();
  const remaining = [];
  for (let k = 0; k < index.length; k += 3) {
    const [a, b, c] = [cellOf[index[k]], cellOf[index[k + 1]], cellOf[index[k + 2]]];
    if (a === b || b === c || c === a) continue;
    const [p, q, r] = [pointOf[index[k]], pointOf[index[k + 1]], pointOf[index[k + 2]]];
    const [low, high] = [Math.min(p, q, r), Math.max(p, q, r)];
    const key = (low * many + (p + q + r - low - high)) * many + high;
    if (seen.has(key)) continue;
    seen.add(key);
    remaining.push(p, q, r);
  }
  return { cellOf, pointOf, index: remaining };
}

/**
 * The reduced surface: all points of a cell have its mean position, so that there are no gaps.
 * @param {Surface} surface @param {ReturnType<typeof latticed>} lattice
 * @returns {Surface}
 */
function reduced({ positions, normals, colours }, { cellOf, pointOf, index }) {
  const means = []; // of cells: sums of positions, count
  const looks = []; // of points: sums of normals and colours, count, cell
  cellOf.forEach((at, k) => {
    const mean = (means[at] ??= [0, 0, 0, 0]);
    const look = (looks[pointOf[k]] ??= [0, 0, 0, 0, 0, 0, 0, at]);
    for (let i = 0; i < 3; i++) {
      mean[i] += positions[3 * k + i];
      look[i] += normals[3 * k + i];
      look[3 + i] += colours[3 * k + i];
    }
    mean[3] += 1;
    look[6] += 1;
  });
  const mesh = { positions: [], normals: [], colours: [], index };
  for (const [x, y, z, red, green, blue, many, at] of looks) {
    const size = Math.hypot(x, y, z) || 1;
    const mean = means[at];
    mesh.positions.push(mean[0] / mean[3], mean[1] / mean[3], mean[2] / mean[3]);
    mesh.normals.push(x / size, y / size, z / size);
    mesh.colours.push(red / many, green / many, blue / many);
  }
  return mesh;
}

/** Reduces a surface. @param {Surface} surface @param {number} cell side of a cell, m */
export const thinned = (surface, cell) => reduced(surface, latticed(surface, kindsOf(surface), cell));

/**
 * Surfaces with at most `most` triangles together, reduced by the finest possible common lattice.
 * @param {Surface[]} surfaces @param {number} most triangles @param {number} finest side of the smallest cell, m
 */
export function within(surfaces, most, finest) {
  const count = (list) => list.reduce((sum, { index }) => sum + index.length / 3, 0);
  if (count(surfaces) <= most) return surfaces;
  const kinds = surfaces.map(kindsOf);
  const lattice = (/** @type {number} */ k) => surfaces.map((surface, i) => latticed(surface, kinds[i], finest * CELL_RATIO ** k));
  let [low, high] = [-1, 0]; // too fine, possibly coarse enough
  let clustered = lattice(high);
  while (count(clustered) > most) {
    [low, high] = [high, 2 * high + 1];
    clustered = lattice(high);
  }
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    const candidate = lattice(middle);
    if (count(candidate) > most) low = middle;
    else [high, clustered] = [middle, candidate];
  }
  return surfaces.map((surface, i) => reduced(surface, clustered[i]));
}
