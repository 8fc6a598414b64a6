// Makes the ground around a terrain, which continues the heights of its border, as for wheels.
import * as THREE from "three";

/** Drawn distance around the focus, m. */
const REACH = 1600;
/** Spacing of the lattice of its centres, m, so that pictures do not depend on the path of the focus. */
const LATTICE_SPACING = 200;

/**
 * Stations of the border: points of patches on the sides of low and high x and y.
 * @param {import("./heights.js").HeightField} field
 * @returns {number[][][]} [normal axis][0 low, 1 high]: increasing coordinates along the side, m
 */
export function borderStations({ patches, low, high }) {
  return [0, 1].map((k) => {
    const along = 1 - k;
    return [low[k], high[k]].map((side) => {
      const coordinates = new Set([low[along], high[along]]);
      for (const { origin, spacing, shape } of patches) {
        const ends = [origin[k], origin[k] + spacing[k] * (shape[k] - 1)];
        if (!ends.some((end) => Math.abs(end - side) < 1e-6)) continue;
        for (let i = 0; i < shape[along]; i++) coordinates.add(Math.round(1e6 * (origin[along] + i * spacing[along])) / 1e6);
      }
      return [...coordinates].sort((a, b) => a - b);
    });
  });
}

/**
 * Stations of a border without those whose heights are on a line between others.
 * @param {number[]} places increasing @param {(place: number) => number} height @param {number} tolerance largest error, m
 */
export function straightened(places, height, tolerance) {
  const kept = [places[0]];
  for (let to = 2, from = 0; to <= places.length; to++) {
    const [a, b] = [places[from], places[Math.min(to, places.length - 1)]];
    const line = (/** @type {number} */ place) => height(a) + ((place - a) / (b - a)) * (height(b) - height(a));
    const fits = to < places.length && places.slice(from + 1, to).every((place) => Math.abs(height(place) - line(place)) <= tolerance);
    if (!fits) kept.push(places[(from = to - 1)]);
  }
  return kept;
}

/** Rectangles of the four sides and corners, as their corner points x, y, z. @param {number[]} centre x and y of the focus */
export function borderQuads(field, stations, centre) {
  const { low, high } = field;
  const quads = [];
  const add = (x0, x1, y0, y1, heights) => {
    if (x1 > x0 && y1 > y0) quads.push([[x0, y0, heights[0]], [x1, y0, heights[1]], [x1, y1, heights[2]], [x0, y1, heights[3]]]); // prettier-ignore
  };
  const beyond = [0, 1].map((k) => [
    [Math.min(low[k], centre[k] - REACH), Math.min(low[k], centre[k] + REACH)],
    [Math.max(high[k], centre[k] - REACH), Math.max(high[k], centre[k] + REACH)],
  ]);
  [low[0], high[0]].forEach((x, end) => {
    const [from, to] = beyond[0][end];
    const list = stations[0][end];
    for (let i = 0; i + 1 < list.length; i++) {
      const [a, b] = [field.at(x, list[i]), field.at(x, list[i + 1])];
      add(from, to, list[i], list[i + 1], [a, a, b, b]);
    }
    [low[1], high[1]].forEach((y, other) => add(from, to, ...beyond[1][other], Array(4).fill(field.at(x, y))));
  });
  [low[1], high[1]].forEach((y, end) => {
    const [from, to] = beyond[1][end];
    const list = stations[1][end];
    for (let i = 0; i + 1 < list.length; i++) {
      const [a, b] = [field.at(list[i], y), field.at(list[i + 1], y)];
      add(list[i], list[i + 1], from, to, [a, b, b, a]);
    }
  });
  return quads;
}

/** Makes the ground. @param {import("./heights.js").HeightField} field @param {THREE.Material} material @param {number} tolerance largest error of heights, m */
export function terrainBorder(field, material, tolerance) {
  const heights = [0, 1].map((k) => [field.low[k], field.high[k]].map((side) => (/** @type {number} */ place) => (k === 0 ? field.at(side, place) : field.at(place, side))));
  const stations = borderStations(field).map((sides, k) => sides.map((places, end) => straightened(places, heights[k][end], tolerance)));
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
  mesh.receiveShadow = true;
  let built = null;
  /** @param {number[]} origin of the picture in the axes of the world, m */
  const follow = (origin) => {
    const near = [0, 1].map((k) => LATTICE_SPACING * Math.round(origin[k] / LATTICE_SPACING));
    if (built === null || near[0] !== built[0] || near[1] !== built[1]) {
      built = near;
      fill(mesh.geometry, borderQuads(field, stations, built), built);
    }
    mesh.position.set(built[0] - origin[0], built[1] - origin[1], -origin[2]);
  };
  return { mesh, follow };
}

function fill(geometry, quads, base) {
  const positions = new Float32Array(12 * quads.length);
  const normals = new Float32Array(12 * quads.length);
  const triangles = [];
  quads.forEach((corners, q) => {
    const [a, b, , d] = corners;
    const slope = [(b[2] - a[2]) / (b[0] - a[0]), (d[2] - a[2]) / (d[1] - a[1])];
    const size = Math.hypot(...slope, 1);
    corners.forEach(([x, y, z], k) => {
      positions.set([x - base[0], y - base[1], z], 12 * q + 3 * k);
      normals.set([-slope[0] / size, -slope[1] / size, 1 / size], 12 * q + 3 * k);
    });
    triangles.push(4 * q, 4 * q + 1, 4 * q + 2, 4 * q, 4 * q + 2, 4 * q + 3);
  });
  geometry.dispose();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  geometry.setIndex(triangles);
  geometry.computeBoundingSphere();
}
