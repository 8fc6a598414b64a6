// Triangles of a terrain: grids with skirts at several levels of detail.

/** Depth of the skirts that hide gaps between pieces, m. */
const SKIRT = 0.6;
/** Strides of the points at the levels of detail. */
const STRIDES = [1, 2, 4, 8, 16, 32];

/**
 * A part of a patch with one level of detail: first indices and numbers of points.
 * @typedef {{patch: import("./heights.js").Patch, i0: number, j0: number, n: number, m: number}} Part
 */

/** Divides patches into parts of at most `cells` cells in each direction. @param {import("./heights.js").Patch[]} patches @returns {Part[]} */
export function parts(patches, cells) {
  const found = [];
  for (const patch of patches) {
    const cuts = patch.shape.map((n) => {
      const count = Math.max(1, Math.ceil((n - 1) / cells));
      return Array.from({ length: count + 1 }, (_, k) => Math.round(((n - 1) * k) / count));
    });
    for (let a = 0; a + 1 < cuts[0].length; a++) {
      for (let b = 0; b + 1 < cuts[1].length; b++) {
        const [i0, j0] = [cuts[0][a], cuts[1][b]];
        found.push({ patch, i0, j0, n: cuts[0][a + 1] - i0 + 1, m: cuts[1][b + 1] - j0 + 1 });
      }
    }
  }
  return found;
}

/**
 * A level of detail of a part: largest error of heights, m, number of triangles, and their points.
 * @typedef {{error: number, count: number, triangles: number[]}} Level
 */

/** Middle of a part. @param {Part} part */
const middleOf = ({ patch, i0, j0, n, m }) => [
  patch.origin[0] + patch.spacing[0] * (i0 + 0.5 * (n - 1)),
  patch.origin[1] + patch.spacing[1] * (j0 + 0.5 * (m - 1)),
];

/**
 * Groups adjacent small parts to about `most` pieces.
 * @param {Part[]} list @param {number} most @param {number} points largest number of points of a piece
 * @returns {Part[][]}
 */
export function bundles(list, most, points) {
  if (list.length <= most) return list.map((part) => [part]);
  const middles = list.map(middleOf);
  let side = 16;
  for (;;) {
    const cells = new Map();
    list.forEach((part, k) => {
      const key = middles[k].map((value) => Math.floor(value / side)).join();
      if (!cells.has(key)) cells.set(key, []);
      cells.get(key).push(part);
    });
    const lines = [...cells.values()].flatMap((cell) => divided(cell, points));
    if (lines.length <= most || cells.size === 1) return lines;
    side *= 2;
  }
}

function divided(cell, points) {
  const found = [];
  let size = Infinity;
  for (const part of cell) {
    const more = part.n * part.m;
    if (size + more > points) {
      found.push([]);
      size = 0;
    }
    found[found.length - 1].push(part);
    size += more;
  }
  return found;
}

/**
 * Points of a piece with skirts, relative to the first point of its first part, and triangles of each part at each level.
 * @param {Part[]} piece
 * @param {import("./heights.js").HeightField} field for the slopes along the borders
 * @returns {{base: number[], positions: Float32Array, normals: Float32Array,
 *   parts: {middle: number[], radius: number, levels: Level[]}[]}} middle: x and y, m
 */
export function pieceParts(piece, field) {
  const first = piece[0];
  const base = [0, 1].map((k) => first.patch.origin[k] + first.patch.spacing[k] * [first.i0, first.j0][k]);
  const count = piece.reduce((sum, { n, m }) => sum + n * m + 2 * (n + m), 0);
  const [positions, normals] = [new Float32Array(3 * count), new Float32Array(3 * count)];
  const starts = [];
  let at = 0;
  for (const part of piece) {
    starts.push(at);
    at = addPoints(part, field, base, positions, normals, at);
  }
  const meshes = piece.map((part, k) => {
    const { patch, n, m } = part;
    const strides = STRIDES.filter((stride) => stride === 1 || stride < Math.min(n, m));
    const levels = strides.map((stride) => levelOf(part, stride, starts[k]));
    return { middle: middleOf(part), radius: 0.5 * Math.hypot((n - 1) * patch.spacing[0], (m - 1) * patch.spacing[1]), levels };
  });
  return { base, positions, normals, parts: meshes };
}

function addPoints({ patch, i0, j0, n, m }, field, base, positions, normals, start) {
  const { origin, spacing, shape, heights } = patch;
  const [dx, dy] = spacing;
  const put = (k, i, j) => {
    const slope = slopeAt(i0 + i, j0 + j);
    const size = Math.sqrt(slope[0] ** 2 + slope[1] ** 2 + 1);
    positions[3 * k] = origin[0] + (i0 + i) * dx - base[0];
    positions[3 * k + 1] = origin[1] + (j0 + j) * dy - base[1];
    positions[3 * k + 2] = height(i0 + i, j0 + j);
    normals[3 * k] = -slope[0] / size;
    normals[3 * k + 1] = -slope[1] / size;
    normals[3 * k + 2] = 1 / size;
  };
  const height = (a, b) => heights[a * shape[1] + b];
  const slopeAt = (a, b) => {
    const inside = a > 0 && b > 0 && a < shape[0] - 1 && b < shape[1] - 1;
    if (!inside) return field.slope(origin[0] + a * dx, origin[1] + b * dy);
    return [(height(a + 1, b) - height(a - 1, b)) / (2 * dx), (height(a, b + 1) - height(a, b - 1)) / (2 * dy)];
  };
  for (let i = 0; i < n; i++) {
    for (let j = 0; j < m; j++) put(start + i * m + j, i, j);
  }
  let k = start + n * m;
  for (const [i, j] of border(n, m)) {
    const above = 3 * (start + i * m + j);
    for (const numbers of [positions, normals]) numbers.copyWithin(3 * k, above, above + 3);
    positions[3 * k++ + 2] -= SKIRT;
  }
  return k;
}

/** Indices of the points of the four sides, corners twice. */
function border(n, m) {
  const found = [];
  for (let j = 0; j < m; j++) found.push([0, j]);
  for (let j = 0; j < m; j++) found.push([n - 1, j]);
  for (let i = 0; i < n; i++) found.push([i, 0]);
  for (let i = 0; i < n; i++) found.push([i, m - 1]);
  return found;
}

/** Every `stride`th of n indices, and the last. */
export function strided(n, stride) {
  const found = [];
  for (let i = 0; i < n - 1; i += stride) found.push(i);
  found.push(n - 1);
  return found;
}

/** A level, whose triangles are made on first use: of most levels they are never drawn. @param {Part} part @returns {Level} */
function levelOf(part, stride, start) {
  const [rows, columns] = [part.n, part.m].map((n) => Math.ceil((n - 1) / stride));
  const count = 2 * rows * columns + 4 * (rows + columns); // with the skirts of four sides
  let triangles;
  return {
    error: errorOf(part, stride),
    count,
    get triangles() {
      return (triangles ??= trianglesOf(part, stride, start));
    },
  };
}

function trianglesOf({ n, m }, stride, start) {
  const [rows, columns] = [strided(n, stride), strided(m, stride)];
  const found = [];
  for (let a = 0; a + 1 < rows.length; a++) {
    for (let b = 0; b + 1 < columns.length; b++) {
      const [p, q] = [start + rows[a] * m, start + rows[a + 1] * m];
      const [j, l] = [columns[b], columns[b + 1]];
      found.push(p + j, q + j, p + l, p + l, q + j, q + l);
    }
  }
  const top = start + n * m;
  const side = (list, above, below, turned) => {
    for (let k = 0; k + 1 < list.length; k++) {
      const [a, b, c, d] = [above(list[k]), above(list[k + 1]), below + list[k], below + list[k + 1]];
      if (turned) found.push(a, c, b, b, c, d);
      else found.push(a, b, c, b, d, c);
    }
  };
  side(columns, (j) => start + j, top, false);
  side(columns, (j) => start + (n - 1) * m + j, top + m, true);
  side(rows, (i) => start + i * m, top + 2 * m, true);
  side(rows, (i) => start + i * m + m - 1, top + 2 * m + n, false);
  return found;
}

/** Largest error of heights interpolated between the remaining points, m. */
export function errorOf({ patch, i0, j0, n, m }, stride) {
  if (stride === 1) return 0;
  const [rows, columns] = [strided(n, stride), strided(m, stride)];
  const height = (i, j) => patch.heights[(i0 + i) * patch.shape[1] + j0 + j];
  let most = 0;
  for (let a = 0; a + 1 < rows.length; a++) {
    for (let b = 0; b + 1 < columns.length; b++) {
      const [i, k, j, l] = [rows[a], rows[a + 1], columns[b], columns[b + 1]];
      const [h00, h10, h01, h11] = [height(i, j), height(k, j), height(i, l), height(k, l)];
      for (let p = i; p <= k; p++) {
        const u = (p - i) / (k - i);
        for (let q = j; q <= l; q++) {
          const v = (q - j) / (l - j);
          const drawn = u + v <= 1 ? h00 + u * (h10 - h00) + v * (h01 - h00) : h11 + (1 - u) * (h01 - h11) + (1 - v) * (h10 - h11);
          most = Math.max(most, Math.abs(height(p, q) - drawn));
        }
      }
    }
  }
  return most;
}

/** Index of the coarsest level with an allowed error. @param {{error: number}[]} levels from the finest @param {number} allowed m */
export function coarsest(levels, allowed) {
  const beyond = levels.findIndex(({ error }, level) => level > 0 && error > allowed);
  return (beyond < 0 ? levels.length : beyond) - 1;
}
