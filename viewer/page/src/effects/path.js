// The path of a point over the ground, drawn as a ribbon up to the current time.
import * as THREE from "three";
import { discard } from "../looks/discard.js";
import { laid, LIFT, MARKS, widen } from "../looks/ground_offset.js";
import { cross, scale, subtract, unit } from "../scene/math.js";
import { place } from "../sources/sampler.js";

/**
 * Edges of a ribbon relative to its first point, and vectors to them from its middle.
 * @param {number[][]} points earth positions, m @param {ArrayLike<number>} epochs of the points @param {number} half of its width, m @param {number[]} up unit vector
 * @returns {{edges: Float32Array, asides: Float32Array}} right and left of each point in turn; the
 *   ribbon keeps its direction during standstill, and is interrupted between epochs
 */
export function ribbonEdges(points, epochs, half, up) {
  const [edges, asides] = [new Float32Array(6 * points.length), new Float32Array(6 * points.length)];
  const beside = (k, other) => (epochs[other] === epochs[k] ? points[other] : points[k]);
  const sides = points.map((_, k) => unit(cross(up, subtract(beside(k, k + 1), beside(k, k - 1)))));
  let side = sides.find((direction) => direction !== null) ?? [0, 1, 0];
  points.forEach((point, k) => {
    side = sides[k] ?? side;
    const from = subtract(point, points[0]);
    for (const edge of [0, 1]) {
      const aside = scale(side, (2 * edge - 1) * half);
      edges.set(from.map((value, axis) => value + aside[axis] + LIFT * up[axis]), 6 * k + 3 * edge);
      asides.set(aside, 6 * k + 3 * edge);
    }
  });
  return { edges, asides };
}

/**
 * Two triangles from each point of a ribbon to the next, degenerate between epochs.
 * @param {ArrayLike<number>} epochs of the points @returns {number[]} indices of edges
 */
export function ribbonTriangles(epochs) {
  const corners = [0, 2, 1, 1, 2, 3];
  return Array.from({ length: epochs.length - 1 }, (_, k) => corners.map((corner) => 2 * k + (epochs[k] === epochs[k + 1] ? corner : 0))).flat();
}

/** A recorded path, drawn up to a time. */
export class Path {
  /**
   * @param {import("../scene/scene_view.js").SceneView} view
   * @param {{times: ArrayLike<number>, epochs: ArrayLike<number>, points: number[][]}} run times, s, not decreasing; epochs,
   *   between which the path is interrupted; earth positions, m
   * @param {{colour: string, width: number, opacity: number, least?: number, under?: number}} look width: m; least: least width,
   *   pixels; without it, the path fades with the distance; under: number of paths drawn over this one
   */
  constructor(view, { times, epochs, points }, { colour, width, opacity, least, under = 0 }) {
    this.times = times;
    this.start = points[0];
    this.geometry = new THREE.BufferGeometry();
    const { edges, asides } = ribbonEdges(points, epochs, width / 2, view.up);
    this.geometry.setAttribute("position", new THREE.BufferAttribute(edges, 3));
    this.geometry.setAttribute("aside", new THREE.BufferAttribute(asides, 3));
    this.geometry.setIndex(ribbonTriangles(epochs));
    const viewport = { value: new THREE.Vector2(1, 1) };
    const look = { color: colour, opacity, toneMapped: false };
    const material = laid(`path-${view.up}-${least}`, MARKS, look, (shader) => widen(shader, viewport, { up: view.up, least, fainter: least === undefined }));
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.onBeforeRender = (renderer) => renderer.getDrawingBufferSize(viewport.value);
    this.mesh.frustumCulled = false; // its bounding box would be that of the whole path
    this.mesh.renderOrder = 1 - 0.01 * under;
    view.world.add(this.mesh);
  }

  /** Shows the path up to a time. @param {number} time s @param {number[]} origin of the picture, earth */
  update(time, origin) {
    this.geometry.setDrawRange(0, 6 * place(this.times, time)[0]);
    this.mesh.position.fromArray(subtract(this.start, origin));
  }

  /** @param {boolean} on */
  show(on) {
    this.mesh.visible = on;
  }

  dispose() {
    discard(this.mesh);
  }
}

/**
 * Paths of points over time.
 * @param {(i: number) => void} move sets the time for `feet` @param {number[]} instants indices of times
 * @param {(() => number[] | null)[]} feet earth positions at that time; null if not known
 * @returns {{points: number[][], at: number[]}[]} one for each of `feet`, without times at which it is not known
 */
export function waysOf(move, instants, feet) {
  const paths = feet.map(() => ({ points: [], at: [] }));
  for (const i of instants) {
    move(i);
    feet.forEach((foot, k) => {
      const point = foot();
      if (point === null) return;
      paths[k].points.push(point);
      paths[k].at.push(i);
    });
  }
  return paths;
}
