// Makes the solids of composite shapes, about y, from the table shapes.json.
import * as THREE from "three";
import { rounded } from "./box.js";
import { between } from "./place.js";

/** Cosine of the angle above which an edge of a profile is sharp. */
const CREASE = Math.cos((35 * Math.PI) / 180);

/** @typedef {Object<string, number>} Lengths lengths of a shape by their names in the table, m */

const GEOMETRIES = { lathe, box, sphere, ring };
/** Least ratio of length to thickness of a box that a draft draws as a tube. */
const BAR = 4;
/** Functions that give the tubes of thin solids for drafts. @type {Object<string, (part: Data, lengths: Lengths) => THREE.Matrix4[] | undefined>} */
const TUBES = { box: bar, ring: chords };

/**
 * Meshes of the parts of a shape.
 * @param {Data[]} parts of the table
 * @param {Lengths} lengths
 * @param {(part: Data) => THREE.Material} look
 * @param {number} [out] outer side along y: 1, -1, or 0 for both
 * @returns {THREE.Mesh[]}
 */
export function composed(parts, lengths, look, out = 0) {
  return parts.flatMap((part) => {
    const [outer, middle] = part.y ?? [0, [0]];
    const heights = out ? [outer * out] : middle;
    const geometry = GEOMETRIES[part.kind](part, lengths);
    const tubes = TUBES[part.kind]?.(part, lengths);
    return heights.flatMap((height) =>
      (part.angles ?? [0]).map((degrees) => {
        const mesh = new THREE.Mesh(geometry, look(part));
        if (tubes) mesh.userData.tubes = tubes;
        const [angle, x] = [(degrees * Math.PI) / 180, (part.x ?? 0) * lengths[part.across]];
        mesh.rotation.y = angle;
        mesh.position.set(x * Math.cos(angle), height * lengths[part.along], -x * Math.sin(angle));
        return mesh;
      }),
    );
  });
}

/** Radii and heights of a profile, upward, m. @param {Data} part @param {Lengths} lengths @returns {number[][]} */
export function profileOf({ from, across, along, profile, mirrored }, lengths) {
  const points = profile.map(([r, y]) => [(from ? lengths[from] : 0) + r * lengths[across], y * lengths[along]]);
  return mirrored ? [...points.map(([r, y]) => [r, -y]), ...points.slice(0, -1).reverse()] : points;
}

function lathe(part, lengths) {
  const points = profileOf(part, lengths);
  const drawn = part.tread === undefined ? withSharpEdges(points) : points; // the texture of a tread depends on the indices of points
  return new THREE.LatheGeometry(drawn.map(([r, y]) => new THREE.Vector2(r, y)), part.turns);
}

/** Profile with sharp points repeated, so that they have two normals. */
function withSharpEdges(points) {
  const directions = points.slice(1).map(([r, y], i) => new THREE.Vector2(r - points[i][0], y - points[i][1]).normalize());
  return points.flatMap((point, i) => (directions[i - 1] && directions[i] && directions[i - 1].dot(directions[i]) < CREASE ? [point, point] : [point]));
}

function box({ size: [x, y, z], across, along }, lengths) {
  return rounded([x * lengths[across], y * lengths[along], z * lengths[across]]);
}

function sphere({ radius, across }, lengths) {
  return new THREE.SphereGeometry(radius * lengths[across], 12, 8);
}

/** Torus, or an arc of it about +z. */
function ring({ radius, thickness, across, sides, turns, arc = 2 * Math.PI }, lengths) {
  const geometry = new THREE.TorusGeometry(radius * lengths[across], thickness * lengths[across], sides, turns, arc);
  return geometry.rotateZ(Math.PI / 2 - arc / 2).rotateX(Math.PI / 2);
}

/** Tubes along a torus. */
function chords({ radius, thickness, across, turns, arc = 2 * Math.PI }, lengths) {
  const count = Math.ceil(turns / 3);
  const at = (k) => arc * (k / count - 0.5);
  const point = (k) => [Math.sin(at(k)), 0, Math.cos(at(k))].map((value) => value * radius * lengths[across]);
  return Array.from({ length: count }, (_, k) => between(point(k), point(k + 1), thickness * lengths[across]));
}

/** Tube in place of a long box. */
function bar({ size: [x, y, z], across, along }, lengths) {
  const sides = [x * lengths[across], y * lengths[along], z * lengths[across]];
  if (sides[0] < BAR * Math.max(sides[1], sides[2])) return undefined;
  return [between([-sides[0] / 2, 0, 0], [sides[0] / 2, 0, 0], Math.hypot(sides[1], sides[2]) / 2)];
}
