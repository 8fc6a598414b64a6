// The motion of a node: thinned, and the largest error of the interpolated motion.
import { Quaternion, Vector3 } from "three";
import { linear, place } from "../sources/sampler.js";

/**
 * A node relative to its parent at all times of a run, rows one after the other.
 * @typedef {object} Motion
 * @property {Float64Array} position m
 * @property {Float64Array} quaternion x, y, z, w, of continuous sign
 * @property {Float64Array} [scale] factors of lengths along its axes
 * @property {Vector3[]} [reach] points of the node, as far out as its shapes, where the motion is compared
 * @property {{axis: Vector3, angle: Float64Array}} [turn] where it turns about an axis at a fixed place: the quaternion is this
 */

/** What is written of a motion. @typedef {{times: number[], position: Float32Array, quaternion: Float32Array, scale?: Float32Array}} Track */

/** Between two times, rad: an interpolation that takes the shorter way needs less than pi. */
const FARTHEST = 1.5;
/** Recorded times at which a motion is compared. */
const LOOKED_AT = 4000;

/** The same rotations with each quaternion on the side of the one before it. @param {Float64Array} values are changed */
export function continuous(values) {
  for (let k = 4; k < values.length; k += 4) {
    let along = 0;
    for (let i = k; i < k + 4; i++) along += values[i] * values[i - 4];
    if (along < 0) for (let i = k; i < k + 4; i++) values[i] = -values[i];
  }
  return values;
}

/** Turns that take y where others take it, from the first on with the least twist: of what is round. @param {Float64Array} values are changed */
export function leastTwist(values) {
  const [now, step, from, to] = [new Quaternion().fromArray(values), new Quaternion(), new Vector3(), new Vector3(0, 1, 0)];
  to.applyQuaternion(now);
  for (let k = 4; k < values.length; k += 4) {
    from.copy(to);
    to.set(0, 1, 0).applyQuaternion(step.fromArray(values, k));
    now.premultiply(step.setFromUnitVectors(from, to)).normalize().toArray(values, k);
  }
  return continuous(values);
}

/**
 * Indices of the times to keep: the first, the last, and between them at most `rate` a second. Of a time that stands twice, a
 * step, the later one is kept: times of a glTF file increase.
 * @param {Float64Array} t s @param {number} rate Hz
 */
export function keptTimes(t, rate) {
  const last = t.length - 1;
  const single = [...t.keys()].filter((k) => k === last || Math.fround(t[k + 1]) > Math.fround(t[k]));
  const count = Math.floor((t[last] - t[0]) * rate * (1 + 1e-9)) + 1;
  if (!(count < single.length) || count < 2) return single;
  const kept = new Set([single[0]]);
  let after = 1;
  for (let n = 0; n < count; n++) {
    const at = t[0] + ((t[last] - t[0]) * n) / (count - 1);
    while (after < single.length - 1 && t[single[after]] < at) after++;
    const [a, b] = [single[after - 1], single[after]];
    kept.add(at - t[a] < t[b] - at ? a : b);
  }
  return [...kept.add(last)];
}

/** The track of a motion with at most `rate` times a second, more where it turns too far between two of them. @param {Motion} motion @param {Float64Array} t @param {number} rate @returns {Track} */
export function thinned({ position, quaternion, scale, turn }, t, rate) {
  let kept = keptTimes(t, rate);
  if (turn) {
    const times = refined(t, kept, turn.angle);
    const angles = times.map((time) => linear(turn.angle, ...place(t, time)));
    const turned = angles.flatMap((angle) => new Quaternion().setFromAxisAngle(turn.axis, angle).toArray());
    return { times, position: Float32Array.from(times.flatMap(() => [...position.subarray(0, 3)])), quaternion: Float32Array.from(turned) };
  }
  const more = () => kept.length < keptTimes(t, Infinity).length;
  for (let finer = rate; largestTurn(quaternion, kept) > FARTHEST && more();) kept = keptTimes(t, (finer *= 2));
  const taken = (values, size) => {
    const made = new Float32Array(size * kept.length);
    kept.forEach((k, n) => made.set(values.subarray(size * k, size * (k + 1)), size * n));
    return made;
  };
  return { times: kept.map((k) => t[k]), position: taken(position, 3), quaternion: taken(quaternion, 4), scale: scale && taken(scale, 3) };
}

/** Kept times with others between them where an angle grows too far. @param {Float64Array} t @param {number[]} kept @param {Float64Array} angle */
function refined(t, kept, angle) {
  return kept.flatMap((k, n) => {
    const before = kept[n - 1] ?? k;
    const parts = Math.max(1, Math.ceil(Math.abs(angle[k] - angle[before]) / FARTHEST));
    return Array.from({ length: parts }, (_, part) => t[before] + ((t[k] - t[before]) * (part + 1)) / parts);
  });
}

/** @param {Float64Array} quaternion @param {number[]} kept */
function largestTurn(quaternion, kept) {
  const [a, b] = [new Quaternion(), new Quaternion()];
  return kept.slice(1).reduce((most, k, n) => Math.max(most, a.fromArray(quaternion, 4 * kept[n]).angleTo(b.fromArray(quaternion, 4 * k))), 0);
}

/**
 * How far a motion as a reader of the file has it, linear and along great arcs, is from the recorded one.
 * @param {Motion} motion @param {Track} track @param {Float64Array} t
 * @returns {[number, number]} of a point of `reach`, m, and of the rotation, rad
 */
export function largestErrors(motion, track, t) {
  const count = Math.min(t.length, LOOKED_AT);
  const [interpolated, recorded] = [motionless(), motionless()];
  let [far, turned] = [0, 0];
  for (let n = 0; n < count; n++) {
    const k = count > 1 ? Math.round((n * (t.length - 1)) / (count - 1)) : 0;
    const [i, share] = place(track.times, t[k]);
    put(interpolated, track, i);
    if (share > 0) {
      const next = put(motionless(), track, i + 1);
      interpolated.position.lerp(next.position, share);
      interpolated.quaternion.slerp(next.quaternion, share);
      interpolated.scale.lerp(next.scale, share);
    }
    put(recorded, motion, k);
    for (const point of motion.reach ?? [new Vector3()]) far = Math.max(far, placed(point, interpolated).distanceTo(placed(point, recorded)));
    const { x, y, z, w } = interpolated.quaternion.conjugate().multiply(recorded.quaternion);
    turned = Math.max(turned, 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)));
  }
  return [far, turned];
}

const motionless = () => ({ position: new Vector3(), quaternion: new Quaternion(), scale: new Vector3(1, 1, 1) });

/** @param {ReturnType<typeof motionless>} pose @param {Motion | Track} motion @param {number} k */
function put(pose, { position, quaternion, scale }, k) {
  pose.position.fromArray(position, 3 * k);
  pose.quaternion.fromArray(quaternion, 4 * k);
  if (scale) pose.scale.fromArray(scale, 3 * k);
  return pose;
}

/** @param {Vector3} point @param {ReturnType<typeof motionless>} pose */
const placed = (point, { position, quaternion, scale }) => point.clone().multiply(scale).applyQuaternion(quaternion).add(position);
