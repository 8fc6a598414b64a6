// Height of the ground below a point, by the roads of a scene.
import { floats } from "../scene/data.js";
import { dot, scale, subtract, unit } from "../scene/math.js";
import { heldWithin } from "./heights.js";
import { between, border, groundAxes, levelOf } from "./roads.js";

const known = new WeakMap();

/** Height along `up`; null where the road has none there. @param {Data} road @param {number[]} up @param {number[]} point */
function heightOn(road, up, point) {
  if (road.kind === "profile") return profile(road, up, point);
  if (road.kind === "grid") return grid(road, up, point);
  if (road.kind !== "flat" && road.kind !== "plane") return null;
  const normal = unit(road.normal ?? up) ?? up;
  const base = road.point ?? scale(up, road.height ?? 0);
  return dot(point, up) + dot(normal, subtract(base, point)) / dot(normal, up);
}

function profile(road, up, point) {
  const base = road.origin ?? [0, 0, 0];
  return dot(base, up) + levelOf(road, dot(subtract(point, base), unit(road.direction ?? [1, 0, 0])));
}

/** Straight along both axes between four points of the grid; that of its border as far as this is drawn. */
function grid(road, up, point) {
  if (!known.has(road)) known.set(road, floats(road.heights));
  const heights = known.get(road);
  const [i, j] = groundAxes(road, up).map((axis, k) => (dot(point, axis) - road.origin[k]) / road.spacing[k]);
  const far = [i, j].some((k, axis) => !(Math.abs(k - heldWithin(k, road.shape[axis])) * road.spacing[axis] <= border));
  return far ? null : between(heights, road.shape[1], i, j);
}

/**
 * Height of the roads at a point, the highest where several lie; null where none can be told.
 * @param {Data[]} roads @param {number[]} up @param {number[]} point of the earth
 */
export function roadHeight(roads, up, point) {
  const heights = roads.map((road) => heightOn(road, up, point)).filter((height) => height !== null);
  return heights.length > 0 ? Math.max(...heights) : null;
}

/**
 * Height of the ground of a scene at a place, of its terrain or its roads; null where none can be told.
 * @param {Data} view the SceneView @param {number[]} point of the earth
 */
export function groundHeight({ scene, up, look }, point) {
  if (look?.height && up[2] > 0.9) return look.height(point[0], point[1]);
  return roadHeight(scene.roads ?? [], up, point);
}
