// Fewer triangles of the same form: points of one cell of a lattice become one point; pure numbers.

/** @typedef {{positions: number[], normals: number[], colours: number[], index: number[]}} Surface */

/** Lattice numbers of one axis are held within this: three of them make one whole number. */
const LINES = 2 ** 17;
/** A lattice and the next coarser one. */
const COARSER = 1.3;

/** Which of the six directions a normal is nearest to: the two sides of a sheet stay apart. */
function side(normals, k) {
  let axis = 0;
  for (const other of [1, 2]) if (Math.abs(normals[3 * k + other]) > Math.abs(normals[3 * k + axis])) axis = other;
  return 2 * axis + (normals[3 * k + axis] < 0 ? 1 : 0);
}

/** A map of numbers to numbers from 0 up, in the order in which they come. */
function numbering() {
  const known = new Map();
  return (key) => {
    const found = known.get(key);
    if (found !== undefined) return found;
    known.set(key, known.size);
    return known.size - 1;
  };
}

/** Colour and side of each point as one number: what keeps points of one cell apart. @param {Surface} surface */
function kindsOf({ normals, colours }) {
  const tints = numbering();
  let [tint, last] = [0, -1]; // points of a part have one colour
  return Uint32Array.from({ length: normals.length / 3 }, (_, k) => {
    if (last < 0 || [0, 1, 2].some((i) => colours[3 * k + i] !== colours[3 * last + i])) tint = tints(`${colours[3 * k]},${colours[3 * k + 1]},${colours[3 * k + 2]}`);
    last = k;
    return 6 * tint + side(normals, k);
  });
}

/**
 * Which points and cells of a lattice the points of a surface belong to, and the triangles that are left.
 * @param {Surface} surface @param {Uint32Array} kinds of its points @param {number} cell side of a cell, m
 */
function latticed({ positions, index }, kinds, cell) {
  const [cells, points] = [numbering(), numbering()];
  const [cellOf, pointOf] = [new Uint32Array(kinds.length), new Uint32Array(kinds.length)];
  const line = (k) => Math.round(positions[k] / cell) + LINES / 2;
  let many = 0;
  kinds.forEach((kind, k) => {
    cellOf[k] = cells((line(3 * k) * LINES + line(3 * k + 1)) * LINES + line(3 * k + 2));
    pointOf[k] = points(kind * kinds.length + cellOf[k]);
    many = Math.max(many, pointOf[k] + 1);
  });
  const seen = new Set();
  const left = [];
  for (let k = 0; k < index.length; k += 3) {
    const [a, b, c] = [cellOf[index[k]], cellOf[index[k + 1]], cellOf[index[k + 2]]];
    if (a === b || b === c || c === a) continue;
    const [p, q, r] = [pointOf[index[k]], pointOf[index[k + 1]], pointOf[index[k + 2]]];
    const [low, high] = [Math.min(p, q, r), Math.max(p, q, r)];
    const key = (low * many + (p + q + r - low - high)) * many + high;
    if (seen.has(key)) continue;
    seen.add(key);
    left.push(p, q, r);
  }
  return { cellOf, pointOf, index: left };
}

/**
 * Points of one cell get the place of their mean, so that no crack opens; triangles within one or two cells go.
 * @param {Surface} surface @param {ReturnType<typeof latticed>} lattice
 * @returns {Surface}
 */
function joined({ positions, normals, colours }, { cellOf, pointOf, index }) {
  const means = []; // of cells: sums of places, and how many
  const looks = []; // of points: sums of normals and colours, how many, and their cell
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

/** @param {Surface} surface @param {number} cell side of a cell, m */
export const thinned = (surface, cell) => joined(surface, latticed(surface, kindsOf(surface), cell));

/**
 * Surfaces with at most so many triangles together: all of one lattice, as fine as that allows.
 * @param {Surface[]} surfaces @param {number} most triangles @param {number} finest side of a cell to begin with, m
 */
export function within(surfaces, most, finest) {
  const count = (list) => list.reduce((sum, { index }) => sum + index.length / 3, 0);
  if (count(surfaces) <= most) return surfaces;
  const kinds = surfaces.map(kindsOf);
  const lattice = (/** @type {number} */ k) => surfaces.map((surface, i) => latticed(surface, kinds[i], finest * COARSER ** k));
  let [low, high] = [-1, 0]; // too fine, and to be tried
  let clustered = lattice(high);
  while (count(clustered) > most) {
    [low, high] = [high, 2 * high + 1];
    clustered = lattice(high);
  }
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    const tried = lattice(middle);
    if (count(tried) > most) low = middle;
    else [high, clustered] = [middle, tried];
  }
  return surfaces.map((surface, i) => joined(surface, clustered[i]));
}
