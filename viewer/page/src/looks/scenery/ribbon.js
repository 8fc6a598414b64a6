// Outlines of paint on the drawn ground: lines with dashes, and arrows.
import looks from "../../../../looks.json" with { type: "json" };
import { LIFT } from "../ground_offset.js";

/** Linear colours of paint. @type {Record<string, number[]>} */
export const PAINTS = looks.paints;

/** Longest and shortest steps along a line, and its largest distance from the ground after thinning, m. */
const [MAX_STEP, MIN_STEP, MAX_OFFSET] = [2, 0.1, 1e-3];
/** The same distance in a draft, m. */
export const DRAFT_OFFSET = 1e-2;

/** Point between a and b. */
const between = (a, b, share) => a.map((value, k) => value + share * (b[k] - value));

/**
 * Painted parts of a line.
 * @param {number[][]} points of its middle @param {number[]} [dash] lengths painted and left out
 * @returns {number[][][]} polylines
 */
export function dashes(points, dash) {
  if (dash === undefined) return [points];
  const period = dash[0] + dash[1];
  const found = [];
  let [distance, open] = [0, [points[0]]];
  for (let i = 0; i + 1 < points.length; i++) {
    const [a, b] = [points[i], points[i + 1]];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    let done = 0;
    while (done < length) {
      const phase = (distance + 1e-9) % period;
      const painted = phase < dash[0];
      const step = Math.min((painted ? dash[0] : period) - phase, length - done);
      done += Math.max(step, 1e-6);
      distance += Math.max(step, 1e-6);
      const at = between(a, b, Math.min(done, length) / length);
      if (painted) open.push(at);
      if (painted && (distance + 1e-6) % period >= dash[0] - 1e-9) {
        found.push(open);
        open = [];
      }
      if (!painted && (distance + 1e-6) % period < 2e-6) open = [at];
    }
  }
  if (open.length > 1) found.push(open);
  return found.filter((stretch) => stretch.length > 1);
}

/**
 * Edges of a line on the ground.
 * @param {number[][]} points of its middle @param {number} width
 * @param {{at: (x: number, y: number) => number, stepAt: (x: number, y: number) => number} | null} ground drawn heights
 * @param {number} [off] largest distance of the edges from the ground after thinning, m
 * @returns {number[][][]} pairs of points: right edge, left edge
 */
export function edges(points, width, ground, off = MAX_OFFSET) {
  const stations = ground === null ? points : dense(points, ground);
  const pairs = stations.map((at, i) => {
    const side = scaledNormal(stations, i);
    return [-0.5, 0.5].map((half) => {
      const [x, y] = [at[0] + half * width * side[0], at[1] + half * width * side[1]];
      return [x, y, (ground === null ? at[2] : ground.at(x, y)) + LIFT];
    });
  });
  return thinned(pairs, off);
}

/** A line with additional points, depending on the resolution of the ground. */
function dense(points, ground) {
  const found = [];
  for (let i = 0; i + 1 < points.length; i++) {
    const [a, b] = [points[i], points[i + 1]];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    for (let done = 0; done < length - 1e-6; ) {
      const at = between(a, b, done / length);
      found.push(at);
      done += Math.min(MAX_STEP, Math.max(MIN_STEP, ground.stepAt(at[0], at[1])));
    }
  }
  found.push(points[points.length - 1]);
  return found;
}

/** Normal of a polyline at a point, scaled so that the width is constant at bends. */
function scaledNormal(stations, i) {
  const normal = (a, b) => {
    const [x, y] = [b[0] - a[0], b[1] - a[1]];
    const size = Math.hypot(x, y) || 1;
    return [-y / size, x / size];
  };
  const before = i > 0 ? normal(stations[i - 1], stations[i]) : null;
  const after = i + 1 < stations.length ? normal(stations[i], stations[i + 1]) : null;
  if (before === null || after === null) return before ?? after ?? [0, 1];
  const sum = [before[0] + after[0], before[1] + after[1]];
  const half = (sum[0] * sum[0] + sum[1] * sum[1]) / 2; // 1 + cosine of the bend
  return half > 0.2 ? sum.map((value) => value / half) : after;
}

/** Pairs without those on straight lines between others. */
function thinned(pairs, off) {
  const kept = [pairs[0]];
  let from = 0;
  for (let to = 2; to < pairs.length; to++) {
    if (fits(pairs, from, to, off)) continue;
    kept.push(pairs[to - 1]);
    from = to - 1;
  }
  kept.push(pairs[pairs.length - 1]);
  return kept;
}

/** Whether all pairs between two others are within a distance of their connecting lines. */
function fits(pairs, from, to, off) {
  if (to - from > 40) return false; // limits the time for long lines
  return [0, 1].every((edge) => {
    const [a, b] = [pairs[from][edge], pairs[to][edge]];
    const length2 = (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 || 1;
    for (let k = from + 1; k < to; k++) {
      const p = pairs[k][edge];
      const t = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length2;
      if (Math.hypot(...[0, 1, 2].map((axis) => p[axis] - a[axis] - t * (b[axis] - a[axis]))) > off) return false;
    }
    return true;
  });
}

/** Outline of an arrow of length 1 along x, as strips of pairs: shaft and head. */
const ARROW = [
  { stations: [-0.5, 0.1], halves: [0.035, 0.035] },
  { stations: [0.1, 0.5], halves: [0.14, 0.0] },
];

/** Outline of an arrow on the ground. @param {{at: number[], yaw: number, length: number}} arrow @param {Data | null} ground @returns {number[][][][]} strips of pairs */
export function arrowStrips({ at, yaw, length = 4 }, ground) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return ARROW.map(({ stations, halves }) => {
    const count = Math.ceil((length * (stations[1] - stations[0])) / 0.5);
    return Array.from({ length: count + 1 }, (_, k) => {
      const t = k / count;
      const along = length * (stations[0] + t * (stations[1] - stations[0]));
      const half = length * (halves[0] + t * (halves[1] - halves[0]));
      return [-half, half].map((aside) => {
        const [x, y] = [at[0] + c * along - s * aside, at[1] + s * along + c * aside];
        return [x, y, (ground === null ? at[2] : ground.at(x, y)) + LIFT];
      });
    });
  });
}
