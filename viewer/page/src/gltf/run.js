// Poses of the frames of a scene at all times of a run, in double precision.
import { Quaternion, Vector3 } from "three";
import { Frames } from "../scene/frames.js";
import { IDENTITY, add, dot, fromQuaternion, scale, toQuaternion, unit } from "../scene/math.js";
import { continuous } from "./motion.js";

/** Row `k` of an array. @param {Float64Array} values @param {number} k @param {number} size of a row */
export const row = (values, k, size) => values.subarray(size * k, size * (k + 1));

/** Frames over a run; missing poses are replaced by the previous one, or at the start by the next one. */
export class Run {
  /** @param {{scene: Data, t: Float64Array, epoch: Float64Array, columns: Object<string, Float64Array>}} recorded t: times of the file, s */
  constructor({ scene, t, epoch, columns }) {
    this.scene = scene;
    this.epoch = epoch;
    this.columns = columns;
    this.count = t.length;
    this.frames = new Frames(scene);
    /** @type {Map<string, {position: Float64Array, quaternion: Float64Array, hidden: number}>} quaternion: x, y, z, w */
    this.ways = new Map(Object.keys(scene.frames).map((name) => [name, this._fixedPoses()]));
    const firsts = new Map();
    for (let k = 0; k < this.count; k++) {
      this.frames.update(this.lookup(k));
      for (const [name, poses] of this.ways) this._store(k, this.frames.pose(name), poses, () => firsts.has(name) || firsts.set(name, k));
    }
    for (const [name, { position, quaternion }] of this.ways) {
      for (let k = firsts.get(name) ?? 0, i = 0; i < k; i++) {
        position.copyWithin(3 * i, 3 * k, 3 * k + 3);
        quaternion.copyWithin(4 * i, 4 * k, 4 * k + 4);
      }
      continuous(quaternion);
    }
    this.ways.set("ground", this._fixedPoses());
  }

  _fixedPoses() {
    const quaternion = new Float64Array(4 * this.count);
    for (let k = 0; k < this.count; k++) quaternion[4 * k + 3] = 1;
    return { position: new Float64Array(3 * this.count), quaternion, hidden: 0 };
  }

  _store(k, { position, rotation, shown }, poses, noteFirst) {
    if (shown) {
      const [w, x, y, z] = toQuaternion(rotation);
      poses.position.set(position, 3 * k);
      poses.quaternion.set([x, y, z, w], 4 * k);
      noteFirst();
      return;
    }
    poses.hidden++;
    if (k === 0) return;
    poses.position.copyWithin(3 * k, 3 * k - 3, 3 * k);
    poses.quaternion.copyWithin(4 * k, 4 * k - 4, 4 * k);
  }

  /** Values of columns at a time. @param {number} k @returns {(name: string) => number | undefined} */
  lookup(k) {
    return (name) => this.columns[name]?.[k];
  }

  /** @param {string} name of a frame @param {number} k @returns {import("../scene/frames.js").Pose} */
  pose(name, k) {
    const { position, quaternion } = this.ways.get(name);
    const [x, y, z, w] = row(quaternion, k, 4);
    return { position: [...row(position, k, 3)], rotation: fromQuaternion([w, x, y, z]) ?? IDENTITY, shown: true, why: "" };
  }

  /** Sets frames to their poses at a time. @param {number} k @param {Iterable<string>} [names] */
  move(k, names = this.ways.keys()) {
    for (const name of names) this.frames.poses.set(name, this.pose(name, k));
  }

  /** The motion of a frame in its parent. @param {string} name @returns {import("./motion.js").Motion} */
  motionOf(name) {
    const { parent, at = [0, 0, 0], axis, angle, direction, way } = this.scene.frames[name] ?? {};
    const { position, quaternion } = this.ways.get(name);
    if (parent === undefined) return { position: position.slice(), quaternion };
    const poses = this._fixedPoses();
    const values = filled(this.columns[way ?? angle]);
    const about = angle === undefined ? null : new Vector3(...unit(axis));
    for (let k = 0; k < this.count; k++) {
      poses.position.set(about === null ? add(at, scale(direction, values[k])) : at, 3 * k);
      if (about !== null) new Quaternion().setFromAxisAngle(about, values[k]).toArray(poses.quaternion, 4 * k);
    }
    return about === null ? poses : { ...poses, turn: { axis: about, angle: values } };
  }

  /** Range of the frames along a direction, m. @param {number[]} direction @returns {[number, number]} */
  extentAlong(direction) {
    let [low, high] = [Infinity, -Infinity];
    for (const [name, { position }] of this.ways) {
      if (name === "ground" && this.ways.size > 1) continue;
      for (let k = 0; k < this.count; k++) {
        const at = dot(direction, row(position, k, 3));
        [low, high] = [Math.min(low, at), Math.max(high, at)];
      }
    }
    return [low, high];
  }
}

/** Values with missing ones replaced by the previous, or at the start by the next. @param {Float64Array} values */
function filled(values) {
  let last = values.find(Number.isFinite) ?? 0;
  return values.map((value) => (last = Number.isFinite(value) ? value : last));
}
