// Makes guard rails and buildings.
import looks from "../../../../looks.json" with { type: "json" };
import { randomNumbers } from "../../common/random.js";
import { atEachPixel, atEachPoint } from "../vertex_code.js";

const { zinc: ZINC, roof: ROOF } = looks.things;
/** Cross section of the beam of a rail of height 1, from below: outward and up. */
const BEAM_PROFILE = [[0.0, 0.6], [0.08, 0.66], [0.08, 0.72], [0.0, 0.8], [0.08, 0.88], [0.08, 0.94], [0.0, 1.0]]; // prettier-ignore
/** Distance of the posts of a rail, m. */
const POST_SPACING = 4;

/**
 * Adds a guard rail.
 * @param {import("./triangles.js").Triangles} triangles @param {{points: number[][], height?: number}} barrier
 * @param {boolean} [coarse] with a third of the points along and across
 */
export function addBarrier(triangles, { points: all, height = 0.8 }, coarse = false) {
  const beam = BEAM_PROFILE.filter((_, k) => !coarse || k % 3 === 0);
  const points = all.filter((_, k) => !coarse || k % 3 === 0 || k === all.length - 1);
  let distance = POST_SPACING / 2;
  for (let i = 0; i + 1 < points.length; i++) {
    const [a, b] = [points[i], points[i + 1]];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 0)) continue;
    const along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    const at = (/** @type {number[]} */ [x, y, z], /** @type {number[]} */ [out, up]) => [x - along[1] * out, y + along[0] * out, z + up * height];
    for (const side of [1, -1]) {
      for (let k = 0; k + 1 < beam.length; k++) {
        const [low, high] = [beam[k], beam[k + 1]].map(([out, up]) => [side * (out + 0.01), up]);
        const corners = side > 0 ? [at(b, low), at(a, low), at(a, high), at(b, high)] : [at(a, low), at(b, low), at(b, high), at(a, high)];
        triangles.quad(corners, ZINC);
      }
    }
    for (; distance < length; distance += POST_SPACING) {
      const foot = a.map((value, k) => value + (distance / length) * (b[k] - value));
      triangles.box([foot[0], foot[1], foot[2] - 0.1], [0.1, 0.12, 0.94 * height + 0.1], Math.atan2(along[1], along[0]), ZINC);
    }
    distance -= length;
  }
}

/** Height of a gable as a share of the width, which counts up to a largest one, m. */
const [GABLE_SHARE, WIDEST_GABLE] = [0.22, 12];
/** Depth of a building below its foot, and how far its roof reaches beyond the walls: along, across, downwards, m. */
const [FOUNDATION, OVERHANG] = [0.5, [0.3, 0.4, 0.1]];
/** Distance of the top of a gable below the roof, m. */
const GABLE_GAP = 0.05;
const WALL_COLOURS = [[0.55, 0.52, 0.46], [0.5, 0.45, 0.36], [0.46, 0.47, 0.48], [0.5, 0.36, 0.27]]; // prettier-ignore

/** Adds a box with windows and a gable roof. @param {import("./triangles.js").Triangles} triangles texture coordinates: m of the wall, negative without windows */
export function addBuilding(triangles, { at, yaw, size }) {
  const [length, width, height] = size;
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const next = randomNumbers(Math.round(17 * at[0] + 31 * at[1]));
  const wall = WALL_COLOURS[Math.floor(WALL_COLOURS.length * next())];
  const eaves = height / (1 + (GABLE_SHARE * Math.min(width, WIDEST_GABLE)) / height);
  triangles.box([at[0], at[1], at[2] - FOUNDATION], [length, width, eaves + FOUNDATION], yaw, wall);
  const corner = (x, y, z) => [at[0] + c * x - s * y, at[1] + s * x + c * y, at[2] + z];
  const none = Array(4).fill([-9, -9]);
  const [l, w, low] = [0.5 * length + OVERHANG[0], 0.5 * width + OVERHANG[1], eaves - OVERHANG[2]];
  for (const side of [1, -1]) {
    triangles.quad([corner(-side * l, -side * w, low), corner(side * l, -side * w, low), corner(side * l, 0, height), corner(-side * l, 0, height)], ROOF, none);
    const x = side * 0.5 * length;
    const corners = [corner(x, -side * 0.5 * width, eaves), corner(x, side * 0.5 * width, eaves), corner(x, 0, height - GABLE_GAP)];
    triangles.quad([...corners, corners[2]], wall, none);
  }
}

/** Adds windows at regular distances to a shader of walls. @param {Data} shader of three.js */
export function windows(shader) {
  atEachPoint(shader, "varying vec2 vWall;", "vWall = uv;");
  atEachPixel(shader, "varying vec2 vWall;", {
    color_fragment: `vec2 pane = abs(mod(vWall - vec2(1.5, 2.1), 3.0) - 1.5);
vec2 blur = max(fwidth(vWall), 1e-4);
vec2 open = 1.0 - smoothstep(vec2(0.55, 0.7) - blur, vec2(0.55, 0.7) + blur, 1.5 - pane);
float glass = step(0.0, vWall.x) * open.x * open.y * clamp(0.6 / max(blur.x, blur.y), 0.0, 1.0);
diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.045, 0.06, 0.075), 0.85 * glass);`,
  });
}
