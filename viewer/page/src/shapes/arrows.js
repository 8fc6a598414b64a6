// Arrows of forces, drawn over everything else; one scale for all arrows of a unit.
import * as THREE from "three";
import { headlight } from "../looks/headlight.js";
import { forcesOf, niceAbove, niceStep } from "../scene/forces.js";
import { add, length, scale, subtract, unit } from "../scene/math.js";
import { stretch } from "./place.js";

const COLOURS = new Map([["N", "#f4511e"], ["N.m", "#8e24aa"]]); // prettier-ignore
const OTHER = "#00897b";
/** Length of the longest arrow beside the size of the drawing. */
const LONGEST = 0.35;

/** The arrows of a scene. */
export class Arrows {
  /** @param {Data[]} list a scene's `arrows` */
  constructor(list) {
    this.list = list;
    /** Size of the drawing, set by the view that measures it. */
    this.extent = 1;
    /** Arrows are drawn so many times longer than fits. */
    this.factor = 1;
    /** Names of the arrows that are drawn. */
    this.shown = new Set(list.map(({ name }) => name));
    /** The number at the longest arrow, by unit. */
    this.ranges = new Map();
    this.now = [];
    this.group = new THREE.Group();
    this.materials = new Map();
    this.shaft = new THREE.CylinderGeometry(1, 1, 1, 14);
    this.head = new THREE.ConeGeometry(1, 1, 20);
    this.pool = [];
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

  /** The scale of a unit in round numbers: an arrow of so many metres is so much. @param {string} name of the unit */
  scaleOf(name) {
    return { metres: niceStep(LONGEST * this.extent * this.factor), value: this.ranges.get(name) ?? 1 };
  }

  /** @param {string} name of the unit @returns {string} */
  colourOf(name) {
    return COLOURS.get(name) ?? OTHER;
  }

  /** @param {number[]} origin of the picture */
  place(origin) {
    while (this.pool.length < this.now.length) this.pool.push(this.#make());
    this.pool.forEach((arrow, i) => this.#put(arrow, this.now[i], origin));
  }

  #make() {
    const arrow = { shaft: new THREE.Mesh(this.shaft), head: new THREE.Mesh(this.head) };
    arrow.shaft.renderOrder = 20;
    arrow.head.renderOrder = 21;
    this.group.add(arrow.shaft, arrow.head);
    return arrow;
  }

  #put({ shaft, head }, force, origin) {
    const direction = force && unit(force.vector);
    const { metres, value } = this.scaleOf(force?.unit);
    const size = direction ? (length(force.vector) * metres) / value : 0;
    shaft.visible = head.visible = size > 0.004 * this.extent;
    if (!shaft.visible) return;
    const thick = Math.min(0.007 * this.extent, 0.12 * size);
    const from = subtract(force.at, origin);
    const neck = add(from, scale(direction, Math.max(0, size - 4.2 * thick)));
    shaft.material = head.material = this.#material(force.unit);
    stretch(shaft, from, neck, thick);
    stretch(head, neck, add(from, scale(direction, size)), 2.3 * thick);
  }

  #material(name) {
    if (!this.materials.has(name)) {
      this.materials.set(name, headlight({ color: this.colourOf(name), front: true }));
    }
    return this.materials.get(name);
  }

  dispose() {
    for (const material of this.materials.values()) material.dispose();
    this.shaft.dispose();
    this.head.dispose();
    this.group.removeFromParent();
  }
}
