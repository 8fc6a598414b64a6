// The shapes, flexible bodies and arrows of a scene, moved by its frames.
import * as THREE from "three";
import { Materials } from "../looks/materials.js";
import { Arrows } from "../shapes/arrows.js";
import { Flexible } from "../shapes/flexible.js";
import { makeShape } from "../shapes/index.js";
import { join } from "../shapes/merged_meshes.js";
import { turn, shaded } from "../shapes/place.js";
import { niceAbove } from "./forces.js";
import { Frames } from "./frames.js";
import { length, rotate, subtract } from "./math.js";
import { roadUnder, tyresOf } from "./tyres.js";

/** Least radius of drawn tubes of flexible bodies, as a share of the size of the drawing. */
const MIN_RADIUS = 0.003;
/** Name of shapes hidden by covers, as in mbs/vehicle/shapes/car_shapes.py. */
const HIDDEN_NAME = "frame tube";
/** Distance of parts of a ghost from those of the run below which they are hidden, as a share of the size of the drawing. */
const COINCIDENCE_DISTANCE = 0.01;

/** The moving parts of a run, or of a ghost. */
export class Parts {
  /**
   * @param {Data} scene
   * @param {{ghost?: boolean, tint?: string, over?: Parts, size?: number, tell: (sentence: string) => void}} options
   *   parts of a ghost are hidden where they coincide with those of `over`, in a drawing of this `size`, m
   */
  constructor(scene, options) {
    this.scene = scene;
    this.options = options;
    this.tell = options.tell;
    this.group = new THREE.Group();
    this.frames = new Frames(scene);
    this.materials = new Materials(options);
    this.carriers = new Map();
    /** Groups of shapes that covers hide, by frame. */
    this.inner = new Map();
    this.shapes = [];
    /** Largest displacement of a flexible body so far, m. */
    this.moved = 0;
    this.owned = [];
    const context = { materials: this.materials, frames: this.frames, scene };
    for (const shape of scene.shapes ?? []) this._add(shape, context, options);
    this.flexible = (scene.flexible ?? []).map((body) => this._makeFlexible(body, options));
    /** Factor of displacements, whether stress is coloured, and stress of the last colour. */
    this.bending = { factor: 1, coloured: true, most: Math.max(0, ...this.flexible.map(({ bending }) => bending.range)) };
    /** Whether the stress of the last colour is fixed. */
    this.bending.fixed = this.bending.most > 0;
    this.tyres = options.ghost ? [] : this._tyres();
    this.arrows = new Arrows(options.ghost ? [] : (scene.arrows ?? []));
    this.group.add(this.arrows.group);
    for (const [, carrier] of this.moving) join(carrier);
    this.close(true);
    for (const { name, why } of scene.missing ?? []) this.tell(`'${name}' is not drawn: ${why.replace(/\.$/, "")}.`);
  }

  _add(shape, context, { ghost = false }) {
    const drawn = makeShape(shape, context);
    if (drawn === null) {
      this.tell(`A shape of the kind '${shape.kind}' is not known to this page and is not drawn.`);
      return;
    }
    if (!ghost) shaded(drawn.object);
    this.owned.push(...(drawn.owned ?? []));
    drawn.shape = shape;
    drawn.object.name = shape.name ?? shape.body ?? "";
    const groups = shape.name === HIDDEN_NAME ? this.inner : this.carriers;
    (drawn.frame !== undefined ? this._carrier(drawn.frame, groups) : this.group).add(drawn.object);
    this.shapes.push(drawn);
  }

  /** Wheels with a known tyre and a shape that can be flattened. */
  _tyres() {
    return tyresOf(this.scene)
      .map(({ tyre, shape }) => ({ tyre, frame: shape?.frame, stand: this.shapes.find((made) => made.shape === shape)?.stand }))
      .filter(({ stand }) => stand !== undefined);
  }

  _makeFlexible(body, { ghost = false }) {
    const flexible = new Flexible(body, this.materials, MIN_RADIUS * (this.scene.extent ?? 0));
    if (!ghost) shaded(flexible.object);
    this._carrier(body.frame).add(flexible.object);
    return flexible;
  }

  /** The group that moves with a frame. */
  _carrier(name, groups = this.carriers) {
    if (!groups.has(name)) {
      const carrier = new THREE.Group();
      groups.set(name, carrier);
      this.group.add(carrier);
    }
    return groups.get(name);
  }

  /** Groups that move with frames, each with the name of its frame. @returns {[string, any][]} */
  get moving() {
    return [...this.carriers, ...this.inner];
  }

  /** @param {((name: string) => number | undefined) | null} lookup values of columns; null: as drawn */
  update(lookup) {
    this.frames.update(lookup);
    for (const { frames } of this.shapes) {
      for (const name of frames) {
        const { shown, why } = this.frames.pose(name);
        if (!shown) this.tell(`${why}.`);
      }
    }
    for (const body of this.flexible) {
      const absent = body.update(lookup, this.bending.factor);
      if (absent) this.tell(absent);
      this.moved = Math.max(this.moved, body.bending.largestMove() / (this.bending.factor || 1));
      if (body.most > this.bending.most && !this.bending.fixed) this.bending.most = niceAbove(body.most);
    }
    for (const { tyre, frame, stand } of this.tyres) {
      stand(lookup === null ? null : roadUnder(tyre, lookup, this.frames.pose(frame)));
    }
    this.arrows.update(lookup, this.frames, this.tell);
  }

  /** Makes covers solid, which hide rigid and flexible parts inside, or transparent. @param {boolean} closed */
  close(closed) {
    this.closed = closed && this.materials.hasCovers;
    this.materials.setCoversClosed(closed);
    for (const { object } of this.flexible) object.visible = !this.closed;
    for (const [name, carrier] of this.inner) carrier.visible = this.frames.pose(name).shown && !this.closed;
  }

  /** Whether frames and their flexible bodies coincide with those of the same names in `over`. @param {string[]} names */
  _coincide(names) {
    const { over, size = 0 } = this.options;
    if (over === undefined || over.closed !== this.closed) return false;
    const near = (name) => frameDistance(this.frames.pose(name), over.frames.pose(name), size / 4) < COINCIDENCE_DISTANCE * size;
    return names.every((name) => near(name) && nodeDistance(this._nodes(name), over._nodes(name)) < COINCIDENCE_DISTANCE * size);
  }

  /** Drawn positions of nodes of the flexible bodies of a frame, in its axes. @param {string} name */
  _nodes(name) {
    return this.flexible.filter(({ frame }) => frame === name).flatMap(({ bending }) => bending.displaced);
  }

  /** Moves all parts, relative to the origin of the picture. @param {number[]} origin earth position */
  place(origin) {
    for (const body of this.flexible) body.paint(this.bending.coloured, this.bending.most || 1);
    this.arrows.place(origin);
    for (const [name, carrier] of this.moving) {
      const { position, rotation, shown } = this.frames.pose(name);
      carrier.visible = shown && !(this.closed && this.inner.get(name) === carrier) && !this._coincide([name]);
      carrier.position.set(...subtract(position, origin));
      turn(carrier, rotation);
    }
    for (const drawn of this.shapes) {
      if (drawn.update === undefined) continue;
      drawn.object.visible = drawn.frames.every((name) => this.frames.pose(name).shown) && !this._coincide(drawn.frames);
      if (drawn.object.visible) drawn.update(([frame, local]) => subtract(this.frames.point(frame, local), origin));
    }
  }

  /** Factor that makes the largest displacement so far about a twentieth of the size. @param {number} extent */
  fittingFactor(extent) {
    return this.moved > 0 ? Math.max(1, niceAbove(extent / 30 / this.moved)) : 1;
  }

  /** Bounding box of all shapes in earth axes: [low, high]; null without shapes. */
  bounds() {
    this.place([0, 0, 0]);
    this.group.updateMatrixWorld(true);
    const box = new THREE.Box3();
    for (const [name, carrier] of this.carriers) {
      if (this.frames.pose(name).shown) box.expandByObject(carrier);
    }
    for (const { object, update, frames } of this.shapes) {
      if (update !== undefined && frames.every((name) => this.frames.pose(name).shown)) box.expandByObject(object);
    }
    return box.isEmpty() ? null : [box.min.toArray(), box.max.toArray()];
  }

  dispose() {
    this.group.traverse((/** @type {THREE.Mesh} */ part) => part.geometry?.dispose());
    for (const body of this.flexible) body.dispose();
    this.arrows.dispose();
    for (const thing of this.owned) thing.dispose();
    this.materials.dispose();
    this.group.removeFromParent();
  }
}

/**
 * Largest distance of points at a distance `reach` along the axes of two frames, m.
 * @param {import("./frames.js").Pose} one @param {import("./frames.js").Pose} other @param {number} reach m
 */
function frameDistance(one, other, reach) {
  if (!other.shown) return Infinity;
  const axes = [[reach, 0, 0], [0, reach, 0], [0, 0, reach]]; // prettier-ignore
  const between = subtract(one.position, other.position);
  const axisDistances = axes.map((axis) => length(subtract(rotate(one.rotation, axis), rotate(other.rotation, axis))));
  return length(between) + Math.max(...axisDistances);
}

/** Largest distance of the nodes of two drawings, m. @param {number[][]} one @param {number[][]} other */
function nodeDistance(one, other) {
  if (one.length !== other.length) return Infinity;
  return one.reduce((most, node, k) => Math.max(most, length(subtract(node, other[k]))), 0);
}
