// Thins the motion of a node, and computes the largest error of the interpolated motion.
import { Quaternion, Vector3 } from "three";
import { linear, place, spread } from "../sources/sampler.js";

/**
 * Pose of a node relative to its parent at all times of a run, row by row.
 * @typedef {object} Motion
 * @property {Float64Array} position m
 * @property {Float64Array} quaternion x, y, z, w, of continuous sign
 * @property {Float64Array} [scale] factors of lengths along its axes
 * @property {Vector3[]} [reach] points of the node at which motions are compared
 * @property {{axis: Vector3, angle: Float64Array}} [turn] rotation of the quaternion, if the node only turns about an axis
 */

/** A thinned motion. @typedef {{times: number[], position: Float32Array, quaternion: Float32Array, scale?: Float32Array}} Track */

/** Largest rotation between two times, rad, below pi so that great arcs are unique. */
const LARGEST_TURN = 1.5;
/** Largest number of times at which motions are compared. */
const MOST_SAMPLES = 4000;

/** Changes signs of quaternions, in place, so that they are continuous. @param {Float64Array} values */
export function continuous(values) {
  for (let k = 4; k < values.length; k += 4) {
    let projection = 0;
    for (let i = k; i < k + 4; i++) projection += values[i] * values[i - 4];
    if (projection < 0) for (let i = k; i < k + 4; i++) values[i] = -values[i];
  }
  return values;
}

/** Removes the twist about y, which does not matter for round objects, in place. @param {Float64Array} values quaternions */
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
 * Indices of retained times: the first, the last, and at most `rate` per second between them. Of equal times, as at a
 * discontinuity, the last is retained, because times of a glTF file must increase.
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

/** A motion with at most `rate` times per second, more for fast rotation. @param {Motion} motion @param {Float64Array} t @param {number} rate @returns {Track} */
export function thinned({ position, quaternion, scale, turn }, t, rate) {
  let kept = keptTimes(t, rate);
  if (turn) {
    const times = refined(t, kept, turn.angle);
    const angles = times.map((time) => linear(turn.angle, ...place(t, time)));
    const largestAngle = angles.flatMap((angle) => new Quaternion().setFromAxisAngle(turn.axis, angle).toArray());
    return { times, position: Float32Array.from(times.flatMap(() => [...position.subarray(0, 3)])), quaternion: Float32Array.from(largestAngle) };
  }
  const canRefine = () => kept.length < keptTimes(t, Infinity).length;
  for (let finer = rate; largestTurn(quaternion, kept) > LARGEST_TURN && canRefine();) kept = keptTimes(t, (finer *= 2));
  const rowsOf = (values, size) => {
    const rows = new Float32Array(size * kept.length);
    kept.forEach((k, n) => rows.set(values.subarray(size * k, size * (k + 1)), size * n));
    return rows;
  };
  return { times: kept.map((k) => t[k]), position: rowsOf(position, 3), quaternion: rowsOf(quaternion, 4), scale: scale && rowsOf(scale, 3) };
}

/** Retained times with additional ones where an angle changes too much. @param {Float64Array} t @param {number[]} kept @param {Float64Array} angle */
function refined(t, kept, angle) {
  return kept.flatMap((k, n) => {
    const before = kept[n - 1] ?? k;
    const parts = Math.max(1, Math.ceil(Math.abs(angle[k] - angle[before]) / LARGEST_TURN));
    return Array.from({ length: parts }, (_, part) => t[before] + ((t[k] - t[before]) * (part + 1)) / parts);
  });
}

/** Largest rotation between retained times, rad. @param {Float64Array} quaternion @param {number[]} kept */
function largestTurn(quaternion, kept) {
  const [a, b] = [new Quaternion(), new Quaternion()];
  return kept.slice(1).reduce((most, k, n) => Math.max(most, a.fromArray(quaternion, 4 * kept[n]).angleTo(b.fromArray(quaternion, 4 * k))), 0);
}

/**
 * Largest errors of the motion interpolated between the times of a track, linearly and along great arcs.
 * @param {Motion} motion @param {Track} track @param {Float64Array} t
 * @returns {[number, number]} of points of `reach`, m, and of the rotation, rad
 */
export function largestErrors(motion, track, t) {
  const [interpolated, recorded] = [identityPose(), identityPose()];
  let [largestDistance, largestAngle] = [0, 0];
  for (const k of spread(t.length, MOST_SAMPLES)) {
    const [i, share] = place(track.times, t[k]);
    setPose(interpolated, track, i);
    if (share > 0) {
      const next = setPose(identityPose(), track, i + 1);
      interpolated.position.lerp(next.position, share);
      interpolated.quaternion.slerp(next.quaternion, share);
      interpolated.scale.lerp(next.scale, share);
    }
    setPose(recorded, motion, k);
    for (const point of motion.reach ?? [new Vector3()]) largestDistance = Math.max(largestDistance, transformed(point, interpolated).distanceTo(transformed(point, recorded)));
    const { x, y, z, w } = interpolated.quaternion.conjugate().multiply(recorded.quaternion);
    largestAngle = Math.max(largestAngle, 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)));
  }
  return [largestDistance, largestAngle];
}

const identityPose = () => ({ position: new Vector3(), quaternion: new Quaternion(), scale: new Vector3(1, 1, 1) });

/** Sets a pose to that of time `k`. @param {ReturnType<typeof identityPose>} pose @param {Motion | Track} motion @param {number} k */
function setPose(pose, { position, quaternion, scale }, k) {
  pose.position.fromArray(position, 3 * k);
  pose.quaternion.fromArray(quaternion, 4 * k);
  if (scale) pose.scale.fromArray(scale, 3 * k);
  return pose;
}

/** Position of a point of a node. @param {Vector3} point @param {ReturnType<typeof identityPose>} pose */
const transformed = (point, { position, quaternion, scale }) => point.clone().multiply(scale).applyQuaternion(quaternion).add(position);
