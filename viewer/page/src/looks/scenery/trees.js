// Makes trees of three kinds, of a trunk and cards with twigs; distant trees have fewer cards.
import * as THREE from "three";
import looks from "../../../../looks.json" with { type: "json" };
import { skylit } from "../skylight.js";
import { randomNumbers } from "../../common/random.js";
import { SIDE, leafTexture } from "./leaves.js";
import { Triangles } from "./triangles.js";

/** Crowns of trees of height 1: middle, half width, half height, cards of near and far trees, colour, tiers of twigs. */
const KINDS = [
  { crown: 0.62, wide: 0.31, high: 0.36, cards: [38, 12], tint: [0.8, 0.95, 0.55] },
  { crown: 0.55, wide: 0.2, high: 0.45, cards: [44, 14], tint: [0.42, 0.62, 0.4], tiers: true },
  { crown: 0.58, wide: 0.13, high: 0.41, cards: [30, 10], tint: [0.72, 0.85, 0.42] },
];
/** Colour of trunks, whose texture coordinates are above 1. */
const BARK = looks.things.bark;
/** Radii of trunks at the ground and in the crown, and depth below the ground, of trees of height 1. */
const [TRUNK_RADIUS, TRUNK_TOP_RADIUS, TRUNK_DEPTH] = [0.028, 0.014, 0.01];
/** Angle from one twig to the next, rad: the golden angle, which spreads them evenly. */
const GOLDEN_ANGLE = 2.399963;
/** Number of cards above which a tree is a near one. */
const NEAR_CARDS = 20;
/** First seed of the shapes of the kinds. */
const FIRST_SEED = 31;
/** Opacity below which a pixel of a leaf is left out; growth of opacity for each level of detail, and most levels. */
const [ALPHA_TEST, ALPHA_GROWTH, ALPHA_LEVELS] = [0.45, 0.4, 4];
/** Half sides of cards in a round crown of near and far trees, as shares of the crown. */
const [NEAR_CARD, FAR_CARD] = [0.62, 0.95];
/** Half side of a branch of a fir as share of its reach, and what is added; its slope down. */
const [BRANCH_SHARE, BRANCH_MORE, BRANCH_SLOPE] = [0.62, 0.03, 0.22];
/** Distance of far trees, m. */
export const FAR_DISTANCE = 120;

/** Kind of a tree. @param {number} seed integer */
export const kindOf = (seed) => Math.floor(3 * randomNumbers(seed)());

/** Width, rotation and colour of a tree. @param {number} seed integer */
export function formOf(seed) {
  const next = randomNumbers(seed);
  next();
  return { wide: 0.85 + 0.4 * next(), turn: 2 * Math.PI * next(), light: 0.75 + 0.45 * next(), yellow: 0.9 + 0.25 * next() };
}

/** Geometries of each kind, near and far, and their common material. */
export class Forest {
  constructor() {
    this.texture = leafTexture();
    this.geometries = KINDS.map((kind, seed) => kind.cards.map((count) => treeGeometry(kind, count, FIRST_SEED + seed)));
    this.material = skylit(
      new THREE.MeshLambertMaterial({ map: this.texture, alphaTest: ALPHA_TEST, vertexColors: true, side: THREE.DoubleSide }),
      addLeaves,
    );
  }

  dispose() {
    this.texture.dispose();
    this.material.dispose();
    for (const geometry of this.geometries.flat()) geometry.dispose();
  }
}

/** Changes a shader so that both sides of leaves have the normal of the crown, and distant leaves stay opaque. */
function addLeaves(shader) {
  shader.fragmentShader = shader.fragmentShader
    .replace("#include <normal_fragment_begin>", "vec3 normal = normalize(vNormal);\nvec3 nonPerturbedNormal = normal;")
    .replace(
      "#include <alphatest_fragment>",
      `vec2 texels = ${SIDE.toFixed(1)} * fwidth(vMapUv);
diffuseColor.a *= 1.0 + ${ALPHA_GROWTH} * clamp(log2(max(texels.x, texels.y)), 0.0, ${ALPHA_LEVELS.toFixed(1)});
if (vMapUv.x > 1.5) diffuseColor = vec4(vColor.rgb, 1.0);
#include <alphatest_fragment>`,
    );
}

function treeGeometry(kind, count, seed) {
  const triangles = new Triangles();
  const next = randomNumbers(seed);
  addTrunk(triangles, kind, count);
  for (let k = 0; k < count; k++) (kind.tiers ? addTier : addTwig)(triangles, kind, k, count, next);
  return triangles.geometry(true);
}

function addTrunk(triangles, { crown }, count) {
  const sides = count > NEAR_CARDS ? 6 : 4;
  const ring = (k, radius, z) => {
    const a = (2 * Math.PI * k) / sides;
    return [radius * Math.cos(a), radius * Math.sin(a), z];
  };
  for (let k = 0; k < sides; k++) {
    const corners = [ring(k, TRUNK_RADIUS, -TRUNK_DEPTH), ring(k + 1, TRUNK_RADIUS, -TRUNK_DEPTH), ring(k + 1, TRUNK_TOP_RADIUS, crown), ring(k, TRUNK_TOP_RADIUS, crown)];
    triangles.quad(corners, BARK, [[2, 0], [2, 0], [2, 1], [2, 1]]); // prettier-ignore
  }
}

/** Adds a card in a round crown, with the normal of the crown. */
function addTwig(triangles, { crown, wide, high, tint }, k, count, next) {
  const z = 1 - (2 * (k + 0.5)) / count;
  const angle = GOLDEN_ANGLE * k + 0.6 * next();
  const flat = Math.sqrt(1 - z * z);
  const light = [flat * Math.cos(angle), flat * Math.sin(angle), z];
  const depth = 0.45 + 0.4 * next();
  const middle = [wide * depth * light[0], wide * depth * light[1], crown + high * depth * light[2]];
  const size = (count > NEAR_CARDS ? NEAR_CARD : FAR_CARD) * Math.min(wide * 1.15, high) * (0.85 + 0.3 * next());
  addCard(triangles, middle, [next() - 0.5, next() - 0.5, 0.7 * (next() - 0.5)], size, light, shade(tint, depth, z));
}

/** Adds a branch of a fir, sloping down and outwards. */
function addTier(triangles, { crown, wide, high, tint }, k, count, next) {
  const up = Math.sqrt((k + 0.5) / count); // fewer near the top
  const z = crown + high * (2 * up - 1);
  const reach = wide * (1.12 - up) * (0.85 + 0.3 * next());
  const angle = GOLDEN_ANGLE * k;
  const out = [Math.cos(angle), Math.sin(angle)];
  const middle = [0.5 * reach * out[0], 0.5 * reach * out[1], z - BRANCH_SLOPE * reach];
  const lean = [0.5 * out[0], 0.5 * out[1], 1];
  const size = BRANCH_SHARE * reach + BRANCH_MORE;
  addCard(triangles, middle, lean, size, [0.8 * out[0], 0.8 * out[1], 0.6], shade(tint, 0.7, 2 * up - 1));
}

/** Colour of a card: darker inside the crown and below. @param {number} depth 0: at the trunk, 1: outside @param {number} z -1: below, 1: above */
const shade = (tint, depth, z) => tint.map((value) => value * (0.45 + 0.45 * depth) * (0.85 + 0.2 * z));

/** Adds a square card perpendicular to a direction, with one normal for lighting. */
function addCard(triangles, middle, across, halfSide, light, colour) {
  const normal = new THREE.Vector3(...across).normalize();
  const x = new THREE.Vector3(0, 0, 1).cross(normal);
  if (x.lengthSq() < 1e-6) x.set(1, 0, 0);
  x.normalize();
  const y = normal.clone().cross(x);
  const numbers = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
    const corner = middle.map((value, k) => value + a * halfSide * x.getComponent(k) + b * halfSide * y.getComponent(k));
    return triangles.point(corner, new THREE.Vector3(...light).normalize().toArray(), colour, [0.5 + 0.5 * a, 0.5 + 0.5 * b]);
  }); // prettier-ignore
  triangles.index.push(numbers[0], numbers[1], numbers[2], numbers[0], numbers[2], numbers[3]);
}
