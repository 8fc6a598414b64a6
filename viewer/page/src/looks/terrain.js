// A world's ground: pieces of a terrain, coarser the farther away, and beyond its border what the border has.
import * as THREE from "three";
import { dot, fromColumns } from "../scene/math.js";
import { turn } from "../shapes/place.js";
import { HeightField, SurfaceRaster } from "./heights.js";
import { apron } from "./apron.js";
import { bundles, coarsest, parts, pieceMesh } from "./terrain_mesh.js";

/** Cells a side of a piece: pieces are left out where they are not in the picture. */
const CELLS = 128;
/** Pieces of a terrain, about. */
const PIECES = 120;
/** Points of a piece that several parts make, at most. */
const POINTS = 60000;
/** Error of the heights that may be seen, in metres: so far away that paint is as thin as a pixel, more with the distance. */
const [LEAST, THIN, ERROR] = [2e-3, 150, 7e-4];

/**
 * @param {THREE.Material} material
 * @param {number[][]} axes x, y and up of the world
 * @param {HeightField} field
 */
export function terrain(material, axes, field) {
  const group = new THREE.Group();
  turn(group, fromColumns(...axes));
  const pieces = bundles(parts(field.patches, CELLS), PIECES, POINTS).map((piece) => drawnPiece(piece, field, material));
  const around = apron(field, material);
  for (const { mesh } of pieces) group.add(mesh);
  group.add(around.mesh);
  /** @param {number[]} origin earth position of the picture's origin @param {number[]} eye of the camera, from there */
  const follow = (origin, eye) => {
    const [from, camera] = [origin, eye].map((point) => axes.map((axis) => dot(point, axis)));
    around.follow(from);
    for (const { mesh, base, levels, middle, radius } of pieces) {
      mesh.position.set(base[0] - from[0], base[1] - from[1], -from[2]);
      const to = middle.map((value, k) => value + mesh.position.getComponent(k) - camera[k]);
      const allowed = LEAST + ERROR * Math.max(0, Math.hypot(...to) - radius - THIN);
      mesh.geometry = levels[coarsest(levels, allowed)].geometry;
    }
  };
  const dispose = () => {
    around.mesh.geometry.dispose();
    for (const { levels } of pieces) for (const { geometry } of levels) geometry.dispose();
  };
  return { group, follow, dispose };
}

/** One geometry a coarseness; they share their points. */
function drawnPiece(piece, field, material) {
  const { base, positions, normals, levels } = pieceMesh(piece, field);
  const [place, way] = [positions, normals].map((values) => new THREE.BufferAttribute(values, 3));
  const ball = new THREE.Box3().setFromBufferAttribute(place).getBoundingSphere(new THREE.Sphere());
  const small = positions.length / 3 <= 65536;
  const made = levels.map(({ error, triangles }) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", place);
    geometry.setAttribute("normal", way);
    geometry.setIndex(new THREE.BufferAttribute(small ? Uint16Array.from(triangles) : triangles, 1));
    geometry.boundingSphere = ball;
    return { error, geometry };
  });
  const mesh = new THREE.Mesh(made[0].geometry, material);
  mesh.receiveShadow = true;
  return { mesh, base, levels: made, middle: ball.center.toArray(), radius: ball.radius };
}

/** Heights and surfaces of a terrain, and what of it has no look of its own. @param {Data} road */
export const groundOf = (road) => ({ field: new HeightField(road), raster: new SurfaceRaster(road.surface) });
