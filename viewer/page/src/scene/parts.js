// The shapes of one scene, placed by its frames.
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

/** Radius of the thinnest tube of a flexible body that is seen, beside the size of the drawing. */
const THINNEST = 0.003;
/** Shapes of this name are hidden by covers, as mbs/vehicle/shapes/tube_frame.py names them. */
const WITHIN = "frame tube";
/** A part of a ghost that is nearer to its like than this, beside the size of the drawing, would be drawn into it. */
const SAME = 0.01;

/** The moving things of a scene: the run itself, or a ghost of another run. */
export class Parts {
  /**
   * @param {Data} scene
   * @param {{ghost?: boolean, tint?: string, opacity?: number, over?: Parts, size?: number, tell: (sentence: string) => void}} options
   *   parts of a ghost are hidden where those that it is drawn `over` stand, of a drawing of this `size`, m
   */
  constructor(scene, options) {
    this.scene = scene;
    this.options = options;
    this.tell = options.tell;
    this.group = new THREE.Group();
    this.frames = new Frames(scene);
    this.materials = new Materials(options);
    this.carriers = new Map();
    /** Groups of what covers hide, by their frames. */
    this.inner = new Map();
    this.shapes = [];
    /** Largest displacement of a flexible body so far, in metres. */
    this.moved = 0;
    this.owned = [];
    const context = { materials: this.materials, frames: this.frames, scene };
    for (const shape of scene.shapes ?? []) this._add(shape, context, options);
    this.flexible = (scene.flexible ?? []).map((body) => this._bend(body, options));
    /** Times that displacements are drawn, whether stress is coloured, and the stress at the end of the colours. */
    this.bending = { factor: 1, coloured: true, most: Math.max(0, ...this.flexible.map(({ bending }) => bending.range)) };
    /** Whether what is beyond that end stays beyond it. */
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
    const among = shape.name === WITHIN ? this.inner : this.carriers;
    (drawn.frame !== undefined ? this._carrier(drawn.frame, among) : this.group).add(drawn.object);
    this.shapes.push(drawn);
  }

  /** Wheels whose tyre is known and whose shape can be flattened. */
  _tyres() {
    return tyresOf(this.scene)
      .map(({ tyre, shape }) => ({ tyre, frame: shape?.frame, stand: this.shapes.find((made) => made.shape === shape)?.stand }))
      .filter(({ stand }) => stand !== undefined);
  }

  _bend(body, { ghost = false }) {
    const flexible = new Flexible(body, this.materials, THINNEST * (this.scene.extent ?? 0));
    if (!ghost) shaded(flexible.object);
    this._carrier(body.frame).add(flexible.object);
    return flexible;
  }

  /** The group that moves with a frame. */
  _carrier(name, among = this.carriers) {
    if (!among.has(name)) {
      const carrier = new THREE.Group();
      among.set(name, carrier);
      this.group.add(carrier);
    }
    return among.get(name);
  }

  /** Groups that move with frames, each with the name of its frame. @returns {[string, any][]} */
  get moving() {
    return [...this.carriers, ...this.inner];
  }

  /** @param {((name: string) => number | undefined) | null} lookup numbers now; null: as drawn */
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

  /** Covers hide the frame that is within, be it rigid or flexible. @param {boolean} closed */
  close(closed) {
    this.closed = closed && this.materials.covered;
    this.materials.cover(closed);
    for (const { object } of this.flexible) object.visible = !this.closed;
    for (const [name, carrier] of this.inner) carrier.visible = this.frames.pose(name).shown && !this.closed;
  }

  /** Whether frames and what bends on them stand where those of the same names do that are drawn already. @param {string[]} names */
  _covers(names) {
    const { over, size = 0 } = this.options;
    if (over === undefined || over.closed !== this.closed) return false;
    const near = (name) => apart(this.frames.pose(name), over.frames.pose(name), size / 4) < SAME * size;
    return names.every((name) => near(name) && bentApart(this._nodes(name), over._nodes(name)) < SAME * size);
  }

  /** Nodes of the flexible bodies on a frame as they are drawn, along its axes. @param {string} name */
  _nodes(name) {
    return this.flexible.filter(({ frame }) => frame === name).flatMap(({ bending }) => bending.displaced);
  }

  /** Puts everything in its place relative to the origin of the picture. @param {number[]} origin earth position */
  place(origin) {
    for (const body of this.flexible) body.paint(this.bending.coloured, this.bending.most || 1);
    this.arrows.place(origin);
    for (const [name, carrier] of this.moving) {
      const { position, rotation, shown } = this.frames.pose(name);
      carrier.visible = shown && !(this.closed && this.inner.get(name) === carrier) && !this._covers([name]);
      carrier.position.set(...subtract(position, origin));
      turn(carrier, rotation);
    }
    for (const drawn of this.shapes) {
      if (drawn.update === undefined) continue;
      drawn.object.visible = drawn.frames.every((name) => this.frames.pose(name).shown) && !this._covers(drawn.frames);
      if (drawn.object.visible) drawn.update(([frame, local]) => subtract(this.frames.point(frame, local), origin));
    }
  }

  /** A factor that draws the largest displacement so far as about a twentieth of the size. @param {number} extent */
  fittingFactor(extent) {
    return this.moved > 0 ? Math.max(1, niceAbove(extent / 30 / this.moved)) : 1;
  }

  /** Earth box of all shapes as they stand: [low, high]; null where nothing is drawn. */
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
 * How far apart points are that lie so far from two frames along their axes, m.
 * @param {import("./frames.js").Pose} one @param {import("./frames.js").Pose} other @param {number} reach m
 */
function apart(one, other, reach) {
  if (!other.shown) return Infinity;
  const axes = [[reach, 0, 0], [0, reach, 0], [0, 0, reach]]; // prettier-ignore
  const between = subtract(one.position, other.position);
  const turned = axes.map((axis) => length(subtract(rotate(one.rotation, axis), rotate(other.rotation, axis))));
  return length(between) + Math.max(...turned);
}

/** How far apart the nodes of two drawings of a frame's flexible bodies are, m. @param {number[][]} one @param {number[][]} other */
function bentApart(one, other) {
  if (one.length !== other.length) return Infinity;
  return one.reduce((most, node, k) => Math.max(most, length(subtract(node, other[k]))), 0);
}
