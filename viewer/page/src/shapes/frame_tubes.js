// The surface of the tubes of a flexible body, with balls at the nodes.
import * as THREE from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { across, cross, subtract, unit } from "../scene/math.js";

const SIDES = 12;
const CIRCLE = Array.from({ length: SIDES }, (_, j) => [Math.cos, Math.sin].map((of) => of((2 * Math.PI * j) / SIDES)));
/** Stride of the points around a tube in a draft; balls are octahedra. */
const DRAFT_STRIDE = 3;

/** A surface of beams and nodes, updated when the nodes move. */
export class FrameTubes {
  /** @param {number[][]} nodes @param {number[][]} beams pairs of nodes @param {number[]} radii of the beams */
  constructor(nodes, beams, radii) {
    this.beams = beams;
    this.radii = radii;
    this.thick = thickness(nodes, beams, radii);
    const [corners, ball] = [new THREE.OctahedronGeometry(1), new THREE.IcosahedronGeometry(1, 1)].map(merged);
    this.ball = ball.points;
    this.first = beams.length * 2 * SIDES;
    const count = this.first + nodes.length * (this.ball.length / 3);
    this.geometry = new THREE.BufferGeometry();
    for (const [name, size] of Object.entries({ position: 3, normal: 3, level: 1 })) {
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(count * size), size));
    }
    const thick = [...radii.flatMap((radius) => Array(2 * SIDES).fill(radius)), ...this.thick.flatMap((radius) => Array(this.ball.length / 3).fill(radius))];
    this.geometry.setAttribute("thick", new THREE.BufferAttribute(Float32Array.from(thick), 1));
    this.geometry.setIndex(this._triangles(nodes.length, 1, ball.index));
    const octahedron = corners.index.map((k) => nearest(corners.points.slice(3 * k, 3 * k + 3), ball.points));
    /** Triangles for drafts, of the same points. */
    this.coarse = new THREE.BufferAttribute(Uint32Array.from(this._triangles(nodes.length, DRAFT_STRIDE, octahedron)), 1);
  }

  /** Index of the beam of a triangle; -1 for a ball. @param {number} face */
  beamAt(face) {
    const sides = this.geometry.getIndex() === this.coarse ? Math.ceil(SIDES / DRAFT_STRIDE) : SIDES;
    const beam = Math.floor(face / (2 * sides));
    return beam < this.beams.length ? beam : -1;
  }

  _triangles(nodes, every, ball) {
    const list = [];
    this.beams.forEach((_, b) => {
      for (let j = 0; j < SIDES; j += every) {
        const [a, c] = [2 * SIDES * b + j, 2 * SIDES * b + ((j + every) % SIDES)];
        list.push(a, c, a + SIDES, c, c + SIDES, a + SIDES);
      }
    });
    const size = this.ball.length / 3;
    for (let i = 0; i < nodes; i++) for (const k of ball) list.push(this.first + i * size + k);
    return list;
  }

  /** Updates the points. @param {number[][]} nodes positions, m */
  move(nodes) {
    const [positions, normals] = ["position", "normal"].map((name) => this.geometry.getAttribute(name));
    this.beams.forEach(([from, to], b) => {
      const z = unit(subtract(nodes[to], nodes[from])) ?? [0, 0, 1];
      const x = across(z);
      const y = cross(z, x);
      for (let j = 0; j < SIDES; j++) {
        const [cosine, sine] = CIRCLE[j];
        const k = 3 * (2 * SIDES * b + j);
        for (let i = 0; i < 3; i++) {
          const normal = x[i] * cosine + y[i] * sine;
          normals.array[k + i] = normals.array[k + i + 3 * SIDES] = normal;
          positions.array[k + i] = nodes[from][i] + normal * this.radii[b];
          positions.array[k + i + 3 * SIDES] = nodes[to][i] + normal * this.radii[b];
        }
      }
    });
    nodes.forEach((node, i) => {
      const base = 3 * this.first + i * this.ball.length;
      for (let k = 0; k < this.ball.length; k++) {
        normals.array[base + k] = this.ball[k];
        positions.array[base + k] = node[k % 3] + this.thick[i] * this.ball[k];
      }
    });
    positions.needsUpdate = normals.needsUpdate = true;
    this.geometry.computeBoundingSphere();
    this.geometry.boundingBox = null;
  }

  /** Updates the colours. @param {ArrayLike<number>} values at both ends of each beam @param {number} most value of the last colour */
  colour(values, most) {
    const level = this.geometry.getAttribute("level");
    const atNode = new Float64Array(this.thick.length);
    this.beams.forEach((beam, b) => {
      beam.forEach((node, end) => {
        const value = values[2 * b + end] / most;
        atNode[node] = Math.max(atNode[node], value);
        level.array.fill(value, SIDES * (2 * b + end), SIDES * (2 * b + end + 1));
      });
    });
    const size = this.ball.length / 3;
    atNode.forEach((value, i) => level.array.fill(value, this.first + i * size, this.first + (i + 1) * size));
    level.needsUpdate = true;
  }
}

/** Points, each once, and triangles of a solid. @param {THREE.BufferGeometry} soup unmerged triangles, freed */
function merged(soup) {
  for (const name of ["normal", "uv"]) soup.deleteAttribute(name);
  const welded = mergeVertices(soup, 1e-6);
  const found = { points: [...welded.getAttribute("position").array], index: [...welded.index.array] };
  for (const geometry of [soup, welded]) geometry.dispose();
  return found;
}

/** Index of the nearest point. @param {number[]} point @param {number[]} points */
function nearest(point, points) {
  const distanceOf = (k) => Math.hypot(...[0, 1, 2].map((i) => points[3 * k + i] - point[i]));
  return [...Array(points.length / 3).keys()].reduce((a, b) => (distanceOf(b) < distanceOf(a) ? b : a));
}

/** Radius of the ball at each node: that of its thickest beam; without beams a common size. */
function thickness(nodes, beams, radii) {
  if (beams.length === 0) {
    const size = [0, 1, 2].map((k) => Math.max(...nodes.map((node) => node[k])) - Math.min(...nodes.map((node) => node[k])));
    return nodes.map(() => Math.max(0.004 * Math.hypot(...size), 1e-4));
  }
  const thick = new Array(nodes.length).fill(0);
  beams.forEach((beam, b) => beam.forEach((node) => (thick[node] = Math.max(thick[node], radii[b]))));
  return thick;
}
