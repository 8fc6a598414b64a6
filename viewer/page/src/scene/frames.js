// Computes the poses of the frames of a scene from columns, in double precision.
import { IDENTITY, aboutAxis, add, axesOfPoints, finite, fromQuaternion, product, rotate, subtract, transpose } from "./math.js";

/**
 * @typedef {{position: number[], rotation: number[], shown: boolean, why: string}} Pose
 *   earth = position + rotation local; `shown` is false if a value is missing, and `why` is the reason
 */

/** The poses of all frames of a scene. */
export class Frames {
  /** @param {Data} scene with `frames` in any order */
  constructor(scene) {
    this.scene = scene;
    /** @type {Map<string, Pose>} */
    this.poses = new Map([["ground", pose([0, 0, 0], IDENTITY)]]);
    this.order = ordered(scene.frames ?? {});
    this.update(null);
  }

  /** @param {((name: string) => number | undefined) | null} lookup values of columns; null: poses as drawn */
  update(lookup) {
    for (const name of this.order) {
      this.poses.set(name, this._poseOf(name, this.scene.frames[name], lookup));
    }
  }

  /** @param {string} name @returns {Pose} */
  pose(name) {
    return this.poses.get(name) ?? hidden(`the frame '${name}' is not in the scene`);
  }

  /** Earth position of a point of a frame; null if the frame is hidden. @returns {number[] | null} */
  point(name, local) {
    const { position, rotation, shown } = this.pose(name);
    return shown ? add(position, rotate(rotation, local)) : null;
  }

  _poseOf(name, frame, lookup) {
    if (frame.way !== undefined) return this._slidingPose(name, frame, lookup);
    if (frame.parent !== undefined) return this._turningPose(name, frame, lookup);
    const hasColumns = frame.position !== undefined;
    if (hasColumns && lookup !== null) return fromColumns(name, frame, lookup);
    if (frame.points !== undefined && frame.on !== undefined) {
      const pointsPose = this._poseOnPoints(name, frame);
      if (pointsPose.shown || lookup !== null || frame.start === undefined) return pointsPose;
    }
    if (frame.start !== undefined) {
      const rotation = fromQuaternion(frame.start[1]);
      return rotation === null ? hidden(`the start of the frame '${name}' has no rotation`) : pose(frame.start[0], rotation);
    }
    return lookup === null && hasColumns ? hidden(`the frame '${name}' has no pose as drawn`) : pose([0, 0, 0], IDENTITY);
  }

  _turningPose(name, frame, lookup) {
    const parent = this.pose(frame.parent);
    if (!parent.shown) return parent;
    let angle = typeof frame.angle === "number" ? frame.angle : (frame.start ?? 0);
    if (typeof frame.angle === "string" && lookup !== null) {
      angle = lookup(frame.angle);
      if (!Number.isFinite(angle)) return hidden(missingText(name, [frame.angle]));
    }
    const turn = aboutAxis(frame.axis ?? [0, 0, 1], angle);
    if (turn === null) return hidden(`the axis of the frame '${name}' has no direction`);
    return pose(add(parent.position, rotate(parent.rotation, frame.at ?? [0, 0, 0])), product(parent.rotation, turn));
  }

  _slidingPose(name, frame, lookup) {
    const parent = this.pose(frame.parent);
    if (!parent.shown) return parent;
    const travel = lookup === null ? (frame.start ?? 0) : lookup(frame.way);
    if (!Number.isFinite(travel)) return hidden(missingText(name, [frame.way]));
    const at = add(frame.at ?? [0, 0, 0], frame.direction.map((part) => travel * part));
    return pose(add(parent.position, rotate(parent.rotation, at)), parent.rotation);
  }

  _poseOnPoints(name, frame) {
    const earth = [];
    for (const [other, local] of frame.on) {
      const point = this.point(other, local);
      if (point === null) return hidden(this.pose(other).why);
      earth.push(point);
    }
    const drawn = axesOfPoints(...earth);
    const local = axesOfPoints(...frame.points);
    if (drawn === null || local === null) return hidden(`the three points of the frame '${name}' lie on one line`);
    const rotation = product(drawn, transpose(local));
    return pose(subtract(earth[0], rotate(rotation, frame.points[0])), rotation);
  }
}

function fromColumns(name, frame, lookup) {
  const position = frame.position.map((column) => lookup(column));
  const quaternion = frame.quaternion?.map((column) => lookup(column)) ?? [1, 0, 0, 0];
  if (!finite(position) || !finite(quaternion)) {
    const columns = [...frame.position, ...(frame.quaternion ?? [])];
    return hidden(missingText(name, columns.filter((column) => !Number.isFinite(lookup(column)))));
  }
  const rotation = fromQuaternion(quaternion);
  return rotation === null ? hidden(`the quaternion of the frame '${name}' is zero`) : pose(position, rotation);
}

const pose = (position, rotation) => ({ position, rotation, shown: true, why: "" });
const hidden = (why) => ({ position: [0, 0, 0], rotation: IDENTITY, shown: false, why });
const missingText = (name, columns) => `'${name}' is not drawn where the column '${columns[0]}' has no number`;

/** Names in an order with parents before children; a cycle is an error. */
function ordered(frames) {
  const order = [];
  const state = new Map();
  const visit = (name, path) => {
    if (state.get(name) === "done" || frames[name] === undefined) return;
    if (state.get(name) === "open") throw new Error(`The frames hang on each other in a circle: ${[...path, name].join(", ")}.`);
    state.set(name, "open");
    const frame = frames[name];
    const parents = frame.parent !== undefined ? [frame.parent] : (frame.on ?? []).map(([other]) => other);
    for (const other of parents) visit(other, [...path, name]);
    state.set(name, "done");
    order.push(name);
  };
  for (const name of Object.keys(frames)) if (name !== "ground") visit(name, []);
  return order;
}
