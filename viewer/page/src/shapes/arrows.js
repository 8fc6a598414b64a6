// Draws arrows of forces over everything else, with one scale for each unit.
import * as THREE from "three";
import { headlight } from "../looks/headlight.js";
import { forcesOf, niceAbove, niceStep } from "../scene/forces.js";
import { add, length, scale, subtract, unit } from "../scene/math.js";
import { stretch } from "./place.js";

const COLOURS = new Map([["N", "#f4511e"], ["N.m", "#8e24aa"]]); // prettier-ignore
const OTHER_COLOUR = "#00897b";
/** Length of the longest arrow as a share of the size of the drawing. */
const MAX_LENGTH = 0.35;

/** The arrows of a scene. */
export class Arrows {
  _instance = new THREE.Object3D();
  _colour = new THREE.Color();

  /** @param {Data[]} list `arrows` of a scene */
  constructor(list) {
    this.list = list;
    /** Size of the drawing, set by the view, m. */
    this.extent = 1;
    /** Factor of the length of arrows. */
    this.factor = 1;
    /** Names of the drawn arrows. */
    this.shown = new Set(list.map(({ name }) => name));
    /** Value of the longest arrow, by unit. */
    this.ranges = new Map();
    this.now = [];
    this.group = new THREE.Group();
    this.material = headlight({ front: true });
    this.shapes = [new THREE.CylinderGeometry(1, 1, 1, 14), new THREE.ConeGeometry(1, 1, 20)];
    /** Instances of all shafts and all heads, remade if there are more arrows. @type {THREE.InstancedMesh[]} */
    this.meshes = [];
  }

  /** @param {((name: string) => number | undefined) | null} lookup @param {import("../scene/frames.js").Frames} frames @param {(sentence: string) => void} tell */
  update(lookup, frames, tell) {
    this.now = [];
    if (lookup === null) return;
    for (const arrow of this.list) {
      if (!this.shown.has(arrow.name)) continue;
      const forces = forcesOf(arrow, frames, lookup);
      if (typeof forces === "string") tell(forces);
      else for (const force of forces) this.now.push({ ...force, unit: arrow.unit ?? "N" });
    }
    for (const { vector, unit: name } of this.now) {
      const size = length(vector);
      if (size > (this.ranges.get(name) ?? 0)) this.ranges.set(name, niceAbove(size));
    }
  }

  /** Scale of a unit: length of an arrow, m, and its value. @param {string} name of the unit */
  scaleOf(name) {
    return { metres: niceStep(MAX_LENGTH * this.extent * this.factor), value: this.ranges.get(name) ?? 1 };
  }

  /** @param {string} name of the unit @returns {string} */
  colourOf(name) {
    return COLOURS.get(name) ?? OTHER_COLOUR;
  }

  /** Updates the instances. @param {number[]} origin of the picture, m */
  place(origin) {
    if (this.now.length > (this.meshes[0]?.instanceMatrix.count ?? 0)) this._make(this.now.length);
    for (const mesh of this.meshes) mesh.count = 0;
    for (const force of this.now) this._addArrow(force, origin);
    for (const mesh of this.meshes) {
      mesh.visible = mesh.count > 0;
      for (const buffer of [mesh.instanceMatrix, mesh.instanceColor]) if (buffer) buffer.needsUpdate = true;
    }
  }

  /** Makes the instances. @param {number} most largest number of arrows */
  _make(most) {
    for (const mesh of this.meshes) mesh.dispose();
    this.group.clear();
    this.meshes = this.shapes.map((shape, k) => {
      const mesh = new THREE.InstancedMesh(shape, this.material, most);
      mesh.renderOrder = 20 + k;
      mesh.frustumCulled = false; // its bounding box would be that of the first arrows
      this.group.add(mesh);
      return mesh;
    });
  }

  _addArrow(force, origin) {
    const direction = unit(force.vector);
    const { metres, value } = this.scaleOf(force.unit);
    const size = direction ? (length(force.vector) * metres) / value : 0;
    if (direction === null || size <= 0.004 * this.extent) return;
    const thick = Math.min(0.007 * this.extent, 0.12 * size);
    const from = subtract(force.at, origin);
    const neck = add(from, scale(direction, Math.max(0, size - 4.2 * thick)));
    const ends = [[from, neck, thick], [neck, add(from, scale(direction, size)), 2.3 * thick]]; // prettier-ignore
    this.meshes.forEach((mesh, k) => {
      const [begin, end, radius] = ends[k];
      stretch(this._instance, begin, end, radius);
      this._instance.updateMatrix();
      mesh.setMatrixAt(mesh.count, this._instance.matrix);
      mesh.setColorAt(mesh.count, this._colour.set(this.colourOf(force.unit)));
      mesh.count++;
    });
  }

  dispose() {
    for (const part of [...this.meshes, ...this.shapes, this.material]) part.dispose();
    this.group.removeFromParent();
  }
}
