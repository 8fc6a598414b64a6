// Computes the height of the ground below a point from the roads of a scene.
import { floats } from "../bytes.js";
import { dot, scale, subtract, unit } from "../scene/math.js";
import { heldWithin } from "./heights.js";
import { between, border, groundAxes, levelOf } from "./roads.js";

const heightsOf = new WeakMap();

/** Height of a road along `up`; null if it has none there. @param {Data} road @param {number[]} up @param {number[]} point */
function heightOn(road, up, point) {
  if (road.kind === "profile") return profileHeight(road, up, point);
  if (road.kind === "grid") return gridHeight(road, up, point);
  if (road.kind !== "flat" && road.kind !== "plane") return null;
  const normal = unit(road.normal ?? up) ?? up;
  const base = road.point ?? scale(up, road.height ?? 0);
  return dot(point, up) + dot(normal, subtract(base, point)) / dot(normal, up);
}

/** Height of a profile. */
function profileHeight(road, up, point) {
  const base = road.origin ?? [0, 0, 0];
  return dot(base, up) + levelOf(road, dot(subtract(point, base), unit(road.direction ?? [1, 0, 0])));
}

/** Bilinear height of a grid, constant beyond its border; null beyond the drawn part. */
function gridHeight(road, up, point) {
  if (!heightsOf.has(road)) heightsOf.set(road, floats(road.heights));
  const heights = heightsOf.get(road);
  const [i, j] = groundAxes(road, up).map((axis, k) => (dot(point, axis) - road.origin[k]) / road.spacing[k]);
  const isBeyond = [i, j].some((k, axis) => !(Math.abs(k - heldWithin(k, road.shape[axis])) * road.spacing[axis] <= border));
  return isBeyond ? null : between(heights, road.shape[1], i, j);
}

/**
 * Largest height of the roads at a point; null if there is none.
 * @param {Data[]} roads @param {number[]} up @param {number[]} point of the earth
 */
export function roadHeight(roads, up, point) {
  const heights = roads.map((road) => heightOn(road, up, point)).filter((height) => height !== null);
  return heights.length > 0 ? Math.max(...heights) : null;
}

/**
 * Height of the terrain or the roads of a scene at a point; null if there is none.
 * @param {Data} view the SceneView @param {number[]} point of the earth
 */
export function groundHeight({ scene, up, look }, point) {
  if (look?.height && up[2] > 0.9) return look.height(point[0], point[1]);
  return roadHeight(scene.roads ?? [], up, point);
}
