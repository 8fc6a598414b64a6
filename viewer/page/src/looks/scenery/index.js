// Makes the scenery: objects and paint along a road, grouped in squares so that those outside the picture are not drawn.
import * as THREE from "three";
import { dot, fromColumns } from "../../scene/math.js";
import { turn } from "../../shapes/place.js";
import { skylit } from "../skylight.js";
import { PAINTS, DRAFT_OFFSET, arrowStrips, dashes, edges } from "./ribbon.js";
import { MOST_TEXTS, addSign, signTexture } from "./signs.js";
import { coneGeometry, postGeometry } from "./small_things.js";
import { FAR_DISTANCE, Forest, formOf, kindOf } from "./trees.js";
import { Triangles } from "./triangles.js";
import { addBarrier, addBuilding, windows } from "./walls.js";

/** Least side of the squares of scenery, m, and their approximate largest number. */
const [MIN_SQUARE_SIDE, SQUARE_COUNT] = [250, 20];

/** Stride of the trees in a draft. */
const TREE_STRIDE = 3;

const KINDS = ["line", "cone", "tree", "sign", "barrier", "post", "building", "arrow"];
const placeOf = (thing) => thing.at ?? thing.points[Math.floor(thing.points.length / 2)];

/** Objects of each square. @param {Data[]} things @returns {Data[][]} */
export function squares(things) {
  const places = things.map(placeOf);
  const side = [0, 1].map((k) => {
    const [low, high] = places.reduce(([a, b], place) => [Math.min(a, place[k]), Math.max(b, place[k])], [Infinity, -Infinity]);
    return high - low;
  });
  const size = Math.max(MIN_SQUARE_SIDE, Math.sqrt((side[0] * side[1]) / SQUARE_COUNT));
  const groups = new Map();
  things.forEach((thing, n) => {
    const key = places[n].slice(0, 2).map((value) => Math.floor(value / size)).join();
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(thing);
  });
  return [...groups.values()];
}

/** Objects that can be drawn, texts of signs, and sentences on objects that cannot. @param {Data[]} things */
function drawable(things) {
  const known = things.filter(({ kind }) => KINDS.includes(kind));
  const unknown = [...new Set(things.filter((thing) => !known.includes(thing)).map(({ kind }) => kind))];
  const tell = unknown.map((kind) => `Scenery of the kind '${kind}' is not known to this page and is not drawn.`);
  const texts = [...new Set(known.filter(({ kind }) => kind === "sign").map(({ text }) => text))];
  if (texts.length > MOST_TEXTS) {
    tell.push(`${texts.length - MOST_TEXTS} of ${texts.length} different texts of signs are not drawn; there may be ${MOST_TEXTS}.`);
    texts.length = MOST_TEXTS;
  }
  return { known, texts, tell };
}

/** Sentences on objects that are not drawn. @param {Data[]} things */
export const tellOf = (things) => drawable(things).tell;

/**
 * Makes the scenery.
 * @param {Data[]} things `scenery` of a scene
 * @param {{axes: number[][], paint: THREE.Material, ground: Data | null, drafted?: boolean}} looks ground: drawn heights;
 *   drafted: in few calls, with few trees
 */
export function makeScenery(things, { axes, paint, ground, drafted = false }) {
  const group = new THREE.Group();
  turn(group, fromColumns(...axes));
  const { known, texts } = drawable(things);
  const shared = makeShared(known, texts, drafted);
  const pieces = [];
  const fewer = () => known.filter(({ kind, seed }, k) => kind !== "tree" || (seed ?? k) % TREE_STRIDE === 0);
  for (const square of drafted ? [fewer()] : squares(known)) {
    if (square.length === 0) continue;
    const base = placeOf(square[0]).slice();
    for (const mesh of squareMeshes(square, base, { shared, texts, paint, ground, off: drafted ? DRAFT_OFFSET : undefined })) {
      group.add(mesh);
      pieces.push({ mesh, base });
    }
  }
  const follow = (origin, eye) => {
    const [from, camera] = [origin, eye].map((point) => axes.map((axis) => dot(point, axis)));
    for (const { mesh, base } of pieces) {
      mesh.position.set(...base.map((value, k) => value - from[k]));
      const levels = mesh.userData.levels;
      if (levels === undefined) continue;
      const { center, radius } = mesh.boundingSphere;
      const distance = Math.hypot(...[0, 1, 2].map((k) => center.getComponent(k) + mesh.position.getComponent(k) - camera[k])) - radius;
      mesh.geometry = levels[drafted || distance > FAR_DISTANCE ? 1 : 0];
    }
  };
  const dispose = () => {
    for (const { mesh } of pieces) {
      mesh.geometry.dispose();
      mesh.dispose?.();
    }
    for (const thing of shared.owned) thing.dispose();
  };
  return { group, follow, dispose };
}

/** Materials and geometries that all squares share, as far as the objects need them. @param {Data[]} things @param {string[]} texts @param {boolean} coarse */
function makeShared(things, texts, coarse) {
  const has = (kind) => things.some((thing) => thing.kind === kind);
  const plain = skylit(new THREE.MeshLambertMaterial({ vertexColors: true }));
  const shared = { plain, owned: [plain], cones: new Map() };
  const own = (thing) => (shared.owned.push(thing), thing);
  if (has("tree")) shared.forest = own(new Forest());
  if (has("post")) shared.post = own(postGeometry(coarse));
  if (has("building")) {
    shared.walls = own(skylit(new THREE.MeshLambertMaterial({ vertexColors: true }), windows));
    shared.walls.defines = { USE_UV: 1 };
  }
  if (texts.length > 0) {
    const map = own(signTexture(texts));
    shared.boards = own(skylit(new THREE.MeshLambertMaterial({ map })));
  }
  shared.cone = (colour) => {
    if (!shared.cones.has(colour)) shared.cones.set(colour, own(coneGeometry(colour, coarse)));
    return shared.cones.get(colour);
  };
  return shared;
}

/** Meshes of the objects of a square. @param {Data[]} square @param {number[]} base its origin @param {Data} looks */
function squareMeshes(square, base, looks) {
  const of = (/** @type {string} */ kind) => square.filter((thing) => thing.kind === kind);
  const meshes = [...merged(of, base, looks), ...repeated(of, base, looks.shared)];
  for (const mesh of meshes) mesh.receiveShadow = mesh.material === looks.paint;
  return meshes;
}

/** Meshes of all lines, walls and signs, one for each material. @param {(kind: string) => any[]} of @param {number[]} base @param {Data} looks */
function merged(of, base, { shared, texts, paint, ground, off }) {
  const [painted, plain, boards, walls] = Array.from({ length: 4 }, () => new Triangles(base));
  for (const line of of("line")) addLine(painted, line, ground, off);
  for (const arrow of of("arrow")) for (const strip of arrowStrips(arrow, ground)) addStrip(painted, strip, PAINTS.white);
  for (const barrier of of("barrier")) addBarrier(plain, barrier, off !== undefined);
  for (const building of of("building")) addBuilding(walls, building);
  for (const sign of of("sign")) {
    const index = texts.indexOf(sign.text);
    if (index >= 0) addSign(boards, plain, sign, index, texts.length);
  }
  const all = [[painted, paint, false], [plain, shared.plain, false], [boards, shared.boards, true], [walls, shared.walls, true]]; // prettier-ignore
  return all.filter(([triangles]) => !triangles.empty).map(([triangles, material, placed]) => new THREE.Mesh(triangles.geometry(placed), material));
}

/** Instanced meshes of cones, posts and trees, one for each form. @param {(kind: string) => any[]} of @param {number[]} base @param {Data} shared */
function repeated(of, base, shared) {
  const meshes = [];
  const colourOf = ({ colour }) => colour ?? "orange";
  for (const colour of new Set(of("cone").map(colourOf))) {
    const cones = of("cone").filter((cone) => colourOf(cone) === colour);
    meshes.push(instances(shared.cone(colour), shared.plain, cones, base, ({ height = 0.5 }) => [height, height, height]));
  }
  const posts = of("post");
  if (posts.length > 0) meshes.push(instances(shared.post, shared.plain, posts, base, ({ height = 1 }) => [1, 1, height]));
  for (let kind = 0; kind < 3; kind++) {
    const trees = of("tree").filter(({ seed }) => kindOf(seed ?? 0) === kind);
    if (trees.length > 0) meshes.push(treeInstances(shared.forest, kind, trees, base));
  }
  return meshes;
}

/** Adds a painted line. @param {Triangles} triangles @param {Data} line @param {any} ground @param {number} [off] */
export function addLine(triangles, { points, width, colour = "white", dash }, ground, off) {
  for (const stretch of dashes(points, dash)) addStrip(triangles, edges(stretch, width, ground, off), PAINTS[colour] ?? PAINTS.white);
}

/** Adds quads between pairs of points: right, left. @param {Triangles} triangles @param {number[][][]} pairs @param {number[]} colour */
export function addStrip(triangles, pairs, colour) {
  let last = null;
  for (const pair of pairs) {
    const aside = pair[1].map((value, k) => 0.5 * (value - pair[0][k]));
    const numbers = pair.map((point, end) => triangles.point(point, [0, 0, 1], colour, [0, 0], end === 0 ? aside.map((value) => -value) : aside));
    if (last !== null) triangles.index.push(last[0], numbers[0], last[1], last[1], numbers[0], numbers[1]);
    last = numbers;
  }
}

/** Instances of a geometry at the positions of objects. */
function instances(geometry, material, things, base, sizeOf) {
  const mesh = new THREE.InstancedMesh(geometry, material, things.length);
  const [matrix, position, size, rotation] = [new THREE.Matrix4(), new THREE.Vector3(), new THREE.Vector3(), new THREE.Quaternion()];
  things.forEach((thing, k) => {
    position.fromArray(thing.at.map((value, axis) => value - base[axis]));
    size.fromArray(sizeOf(thing));
    rotation.setFromAxisAngle(new THREE.Vector3(0, 0, 1), thing.yaw ?? 0);
    mesh.setMatrixAt(k, matrix.compose(position, rotation, size));
  });
  mesh.computeBoundingSphere();
  return mesh;
}

/** Instances of the trees of a kind. */
function treeInstances(forest, kind, trees, base) {
  const things = trees.map((tree) => ({ at: tree.at, yaw: formOf(tree.seed ?? 0).turn, tree }));
  const mesh = instances(forest.geometries[kind][0], forest.material, things, base, ({ tree }) => {
    const { wide } = formOf(tree.seed ?? 0);
    return [tree.height * wide, tree.height * wide, tree.height];
  });
  const colour = new THREE.Color();
  trees.forEach((tree, k) => {
    const { light, yellow } = formOf(tree.seed ?? 0);
    mesh.setColorAt(k, colour.setRGB(light * yellow, light, light * 0.9));
  });
  mesh.userData.levels = forest.geometries[kind];
  return mesh;
}
