// Collects coloured triangles and builds geometries from them.
import * as THREE from "three";
import { cross, subtract, unit } from "../../scene/math.js";

/** A list of triangles, whose positions are relative to `base`. */
export class Triangles {
  /** @param {number[]} [base] */
  constructor(base = [0, 0, 0]) {
    this.base = base;
    this.positions = [];
    this.normals = [];
    this.colours = [];
    this.places = [];
    this.asides = [];
    this.index = [];
  }

  /** Adds a point. @param {number[]} at @param {number[]} normal @param {number[]} colour linear @param {number[]} [uv] @param {number[]} [aside] from the middle of a line @returns {number} its index */
  point(at, normal, colour, uv = [0, 0], aside = []) {
    this.positions.push(...subtract(at, this.base));
    this.normals.push(...normal);
    this.colours.push(...colour);
    this.places.push(...uv);
    this.asides.push(...aside);
    return this.positions.length / 3 - 1;
  }

  /** Adds a flat face of four corners, counterclockwise as seen from outside. @param {number[][]} corners @param {number[]} colour @param {number[][]} [uvs] */
  quad(corners, colour, uvs = []) {
    const [a, b, , d] = corners;
    const normal = unit(cross(subtract(b, a), subtract(d, a))) ?? [0, 0, 0];
    const first = corners.map((corner, k) => this.point(corner, normal, colour, uvs[k]))[0];
    this.index.push(first, first + 1, first + 2, first, first + 2, first + 3);
  }

  /** Adds a box. @param {number[]} at middle of its base @param {number[]} size @param {number} yaw @param {number[]} colour */
  box(at, [length, width, height], yaw, colour) {
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    const corner = (x, y, z) => [at[0] + c * x * length - s * y * width, at[1] + s * x * length + c * y * width, at[2] + z * height];
    const ring = [[0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]]; // prettier-ignore
    ring.forEach(([x, y], k) => {
      const [u, v] = ring[(k + 1) % 4];
      const along = k % 2 === 0 ? width : length;
      const uvs = [[0, 0], [along, 0], [along, height], [0, height]]; // prettier-ignore
      this.quad([corner(x, y, 0), corner(u, v, 0), corner(u, v, 1), corner(x, y, 1)], colour, uvs);
    });
    this.quad(ring.map(([x, y]) => corner(x, y, 1)), colour);
  }

  get empty() {
    return this.index.length === 0;
  }

  /** Builds the geometry. @param {boolean} [withUv] with texture coordinates */
  geometry(withUv = false) {
    const geometry = new THREE.BufferGeometry();
    const put = (name, values, size) => geometry.setAttribute(name, new THREE.BufferAttribute(Float32Array.from(values), size));
    put("position", this.positions, 3);
    put("normal", this.normals, 3);
    put("color", this.colours, 3);
    if (withUv) put("uv", this.places, 2);
    if (this.asides.length > 0) put("aside", this.asides, 3);
    geometry.setIndex(this.index);
    geometry.computeBoundingSphere();
    return geometry;
  }
}
