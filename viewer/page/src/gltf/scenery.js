// Meshes of the scenery of a world near the path of the run.
import * as THREE from "three";
import looks from "../../../looks.json" with { type: "json" };
import { addLine, addStrip } from "../looks/scenery/index.js";
import { PAINTS, arrowStrips } from "../looks/scenery/ribbon.js";
import { addSign } from "../looks/scenery/signs.js";
import { coneGeometry, postGeometry, turned } from "../looks/scenery/small_things.js";
import { Triangles } from "../looks/scenery/triangles.js";
import { addBarrier, addBuilding } from "../looks/scenery/walls.js";

const MOST_TREES = 1500;

/** Adds a scaled geometry at a position. @param {Triangles} triangles @param {THREE.BufferGeometry} geometry @param {number[]} at @param {number[]} size */
function addGeometry(triangles, geometry, at, size) {
  const [points, normals, colours] = ["position", "normal", "color"].map((name) => geometry.getAttribute(name).array);
  const vector = (values, i) => [...values.subarray(3 * i, 3 * i + 3)];
  const first = triangles.positions.length / 3;
  for (let i = 0; i < points.length / 3; i++) {
    triangles.point(vector(points, i).map((value, k) => at[k] + size[k] * value), vector(normals, i), vector(colours, i));
  }
  triangles.index.push(...[...geometry.index.array].map((number) => first + number));
}

/** Adds a sign without its text. */
function sign(triangles, thing) {
  const board = new Triangles();
  addSign(board, triangles, thing, 0, 1);
  const [a, b, c, d] = [0, 3, 6, 9].map((k) => board.positions.slice(k, k + 3));
  triangles.quad([a, b, c, d], looks.things.board);
}

/** Adds a tree of trunk and crown. */
function tree(triangles, { at, height }) {
  const rings = (colour, profile) => profile.map(([radius, z]) => ({ radius, z, colour }));
  const whole = new Triangles();
  turned(whole, rings(looks.things.bark, [[0.028, -0.01], [0.014, 0.5]]), 5); // prettier-ignore
  turned(whole, rings(looks.things.leaves, [[0.001, 0.22], [0.2, 0.34], [0.24, 0.55], [0.14, 0.83], [0.001, 1]]), 7); // prettier-ignore
  addGeometry(triangles, whole.geometry(), at, [height, height, height]);
}

/** Functions that add an object, by its kind. @type {Object<string, (triangles: Triangles, thing: Data) => void>} */
const ADDERS = {
  line: (triangles, line) => addLine(triangles, line, null),
  arrow: (triangles, arrow) => arrowStrips(/** @type {any} */ (arrow), null).forEach((strip) => addStrip(triangles, strip, PAINTS.white)),
  barrier: (triangles, barrier) => addBarrier(triangles, /** @type {any} */ (barrier)),
  building: addBuilding,
  sign,
  tree,
  cone: (triangles, { at: place, colour, height = 0.5 }) => addGeometry(triangles, coneGeometry(colour), place, [height, height, height]),
  post: (triangles, { at: place, height = 1 }) => addGeometry(triangles, postGeometry(), place, [1, 1, height]),
};

/**
 * Objects in a rectangle as one mesh for each kind; at most `MOST_TREES` trees.
 * @param {Data[]} things @param {number[][]} ways low and high along x and y of the world
 * @returns {{meshes: {kind: string, geometry: THREE.BufferGeometry, base: number[], material: THREE.Material}[], left: number}} base: in the axes of the
 *   world; left: number of objects that are not drawn
 */
export function scenery(things, ways) {
  let trees = 0;
  const near = things.filter(({ kind, at, points = [at] }) => {
    const inside = ways.every(([low, high], k) => points.some((point) => point[k] >= low) && points.some((point) => point[k] <= high));
    return inside && (kind !== "tree" || ++trees <= MOST_TREES);
  });
  const meshes = [...new Set(near.map(({ kind }) => kind))].map((kind) => {
    const sameKind = near.filter((thing) => thing.kind === kind);
    const triangles = new Triangles(sameKind[0].at ?? sameKind[0].points[0]);
    for (const thing of sameKind) ADDERS[kind](triangles, thing);
    const material = new THREE.MeshStandardMaterial({ name: kind, roughness: 0.85, side: THREE.DoubleSide });
    return { kind, geometry: triangles.geometry(), base: triangles.base, material };
  });
  return { meshes, left: things.length - near.length };
}
