// Makes the terrain of a world, with levels of detail by the distance from the camera.
import * as THREE from "three";
import { dot, fromColumns } from "../scene/math.js";
import { turn } from "../shapes/place.js";
import { terrainBorder } from "./terrain_border.js";
import { bundles, coarsest, parts, pieceParts } from "./terrain_mesh.js";

/**
 * Level of detail of a ground: cells of a side of a part; pieces, which are not drawn outside the picture; largest number of
 * triangles; and allowed error of heights, m: `least` up to the distance `near`, plus `error` for each metre beyond.
 * @typedef {{cells: number, pieces: number, most: number, least: number, near: number, error: number}} LevelOfDetail
 */

/** The error is below a pixel where paint is wider than a pixel. @type {LevelOfDetail} */
export const FINE = { cells: 128, pieces: 120, most: Infinity, least: 2e-3, near: 150, error: 7e-4 };
/** For few calls; the error near the camera is covered by the depth offset of paint. @type {LevelOfDetail} */
export const ROUGH = { cells: 64, pieces: 14, most: 15000, least: 8e-3, near: 0, error: 2.5e-3 };
/** Largest number of points of a piece. */
const MAX_POINTS = 60000;
/** Factor of the error of distant parts, repeated while there are too many triangles. */
const ERROR_FACTOR = 1.25;
/** Motion of the eye after which levels are chosen again, m. */
const UPDATE_DISTANCE = 15;

/**
 * Makes the terrain.
 * @param {THREE.Material} material
 * @param {number[][]} axes x, y and up of the world
 * @param {import("./heights.js").HeightField} field
 * @param {LevelOfDetail} detail
 */
export function terrain(material, axes, field, detail) {
  const group = new THREE.Group();
  turn(group, fromColumns(...axes));
  const pieces = bundles(parts(field.patches, detail.cells), detail.pieces, MAX_POINTS).map((piece) => meshOf(pieceParts(piece, field), material));
  const around = terrainBorder(field, material, detail.least);
  group.add(...pieces.map(({ mesh }) => mesh), around.mesh);
  let chosen = null;
  /** @param {number[]} origin earth position of the origin of the picture, m @param {number[]} eye camera, relative to the origin, m */
  const follow = (origin, eye) => {
    const from = axes.map((axis) => dot(origin, axis));
    const camera = axes.slice(0, 2).map((axis, k) => from[k] + dot(eye, axis));
    around.follow(from);
    const moved = chosen === null || Math.hypot(camera[0] - chosen[0], camera[1] - chosen[1]) > UPDATE_DISTANCE;
    for (const { mesh, base } of pieces) mesh.position.set(base[0] - from[0], base[1] - from[1], -from[2]);
    if (!moved) return;
    chosen = camera;
    const levels = levelsWithin(pieces.map(({ parts: drawn }) => drawn), camera, detail);
    pieces.forEach(({ choose }, k) => choose(levels[k]));
  };
  const dispose = () => {
    for (const { mesh } of [...pieces, around]) mesh.geometry.dispose();
  };
  return { group, follow, dispose };
}

/**
 * Levels of all parts of all pieces, within the largest number of triangles.
 * @param {{middle: number[], radius: number, levels: {error: number, count: number}[]}[][]} pieces
 * @param {number[]} eye x and y in the world @param {LevelOfDetail} detail
 * @returns {number[][]}
 */
export function levelsWithin(pieces, eye, { most, least, near, error: first }) {
  const distances = pieces.map((drawn) => drawn.map(({ middle, radius }) => Math.hypot(eye[0] - middle[0], eye[1] - middle[1]) - radius - near));
  for (let error = first; ; error *= ERROR_FACTOR) {
    const chosen = pieces.map((drawn, k) => drawn.map(({ levels }, i) => coarsest(levels, least + error * Math.max(0, distances[k][i]))));
    const count = pieces.flatMap((drawn, k) => drawn.map(({ levels }, i) => levels[chosen[k][i]].count));
    if (error > 1 || count.reduce((sum, value) => sum + value, 0) <= most) return chosen;
  }
}

function meshOf({ base, positions, normals, parts: drawn }, material) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  geometry.computeBoundingSphere();
  const finest = drawn.reduce((sum, { levels }) => sum + 3 * levels[0].count, 0);
  const index = new THREE.BufferAttribute(new Uint32Array(finest), 1).setUsage(THREE.DynamicDrawUsage);
  geometry.setIndex(index);
  let before = "";
  /** @param {number[]} levels of the parts */
  const choose = (levels) => {
    const now = levels.join("");
    if (now === before) return;
    before = now;
    let used = 0;
    drawn.forEach((part, k) => {
      const { triangles } = part.levels[levels[k]];
      index.array.set(triangles, used);
      used += triangles.length;
    });
    index.clearUpdateRanges();
    index.addUpdateRange(0, used);
    index.needsUpdate = true;
    geometry.setDrawRange(0, used);
  };
  const mesh = new THREE.Mesh(geometry, material);
  mesh.receiveShadow = true;
  return { mesh, base, parts: drawn, choose };
}
