// Fewer triangles of the same form: points of one cell of a lattice become one point; pure numbers.

/** @typedef {{positions: number[], normals: number[], colours: number[], index: number[]}} Surface */

/** Which of the six directions a normal is nearest to: the two sides of a sheet stay apart. */
function side(normals, k) {
  const sizes = [0, 1, 2].map((axis) => Math.abs(normals[3 * k + axis]));
  const axis = sizes.indexOf(Math.max(...sizes));
  return 2 * axis + (normals[3 * k + axis] < 0 ? 1 : 0);
}

/**
 * Points of one cell get the place of their mean, so that no crack opens; triangles within one or two cells go.
 * @param {Surface} surface @param {number} cell side of a cell, m
 * @returns {Surface}
 */
export function thinned({ positions, normals, colours, index }, cell) {
  const [cells, points] = [new Map(), new Map()];
  const [cellOf, pointOf] = [[], []];
  const join = (map, key, values) => {
    let held = map.get(key);
    if (held === undefined) map.set(key, (held = { number: map.size, count: 0, sums: values.map(() => 0) }));
    held.count += 1;
    values.forEach((value, i) => (held.sums[i] += value));
    return held;
  };
  const three = (list, k) => [list[3 * k], list[3 * k + 1], list[3 * k + 2]];
  for (let k = 0; k < positions.length / 3; k++) {
    const place = three(positions, k);
    const key = place.map((value) => Math.round(value / cell)).join();
    cellOf.push(join(cells, key, place));
    const colour = three(colours, k);
    pointOf.push(join(points, `${key} ${side(normals, k)} ${colour}`, [...three(normals, k), ...colour]));
    pointOf[k].cell = cellOf[k];
  }
  const made = { positions: [], normals: [], colours: [], index: [] };
  for (const { cell: held, count, sums } of points.values()) {
    const size = Math.hypot(sums[0], sums[1], sums[2]) || 1;
    made.positions.push(...held.sums.map((sum) => sum / held.count));
    made.normals.push(...sums.slice(0, 3).map((sum) => sum / size));
    made.colours.push(...sums.slice(3).map((sum) => sum / count));
  }
  const seen = new Set();
  for (let k = 0; k < index.length; k += 3) {
    const corners = [index[k], index[k + 1], index[k + 2]];
    const [a, b, c] = corners.map((point) => cellOf[point].number);
    if (a === b || b === c || c === a) continue;
    const numbers = corners.map((point) => pointOf[point].number);
    const key = [...numbers].sort((p, q) => p - q).join();
    if (seen.has(key)) continue;
    seen.add(key);
    made.index.push(...numbers);
  }
  return made;
}

/**
 * Surfaces with at most so many triangles together: all of one lattice, as fine as that allows.
 * @param {Surface[]} surfaces @param {number} most triangles @param {number} finest side of a cell to begin with, m
 */
export function within(surfaces, most, finest) {
  const count = (list) => list.reduce((sum, { index }) => sum + index.length / 3, 0);
  let made = surfaces;
  for (let cell = finest; count(made) > most; cell *= 1.3) made = surfaces.map((surface) => thinned(surface, cell));
  return made;
}
