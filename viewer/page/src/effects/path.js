// The path of a point over the ground: a ribbon up to the instant that is shown.
import * as THREE from "three";
import { discard } from "../looks/discard.js";
import { laid, LIFT, MARKS, widen } from "../looks/ground_offset.js";
import { cross, scale, subtract, unit } from "../scene/math.js";
import { place } from "../sources/sampler.js";

/**
 * Both edges of a ribbon, relative to its first point, and the ways to them from its middle.
 * @param {number[][]} points earth @param {ArrayLike<number>} epochs of each @param {number} half of its width, m @param {number[]} up unit vector
 * @returns {{edges: Float32Array, asides: Float32Array}} right and left of each point in turn; where nothing moves the
 *   ribbon keeps its direction; another epoch has nothing to do with the one before
 */
export function ribbonEdges(points, epochs, half, up) {
  const [edges, asides] = [new Float32Array(6 * points.length), new Float32Array(6 * points.length)];
  const beside = (k, other) => (epochs[other] === epochs[k] ? points[other] : points[k]);
  const sides = points.map((_, k) => unit(cross(up, subtract(beside(k, k + 1), beside(k, k - 1)))));
  let side = sides.find((found) => found !== null) ?? [0, 1, 0];
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
 * Two triangles from each point of a ribbon to the next; without a size where another epoch begins.
 * @param {ArrayLike<number>} epochs of the points @returns {number[]} indices of edges
 */
export function ribbonTriangles(epochs) {
  const corners = [0, 2, 1, 1, 2, 3];
  return Array.from({ length: epochs.length - 1 }, (_, k) => corners.map((corner) => 2 * k + (epochs[k] === epochs[k + 1] ? corner : 0))).flat();
}

/** A path that is known before it is driven, drawn up to an instant. */
export class Path {
  /**
   * @param {import("../scene/scene_view.js").SceneView} view
   * @param {{times: ArrayLike<number>, epochs: ArrayLike<number>, points: number[][]}} run not decreasing times, epochs between which
   *   there is nothing, and earth positions
   * @param {{colour: string, width: number, opacity: number, least?: number, under?: number}} look width: m; least: pixels that it is
   *   wide, however far it is; without it, it becomes fainter there; under: how many paths are drawn over it
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
    this.mesh.frustumCulled = false; // its box would be that of the whole path
    this.mesh.renderOrder = 1 - 0.01 * under;
    view.world.add(this.mesh);
  }

  /** Show it up to a time. @param {number} time s @param {number[]} origin of the picture, earth */
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
 * Where points are over time.
 * @param {(i: number) => void} move brings what `feet` look at to an instant @param {number[]} instants indices
 * @param {(() => number[] | null)[]} feet earth positions at that instant; null where one is not known
 * @returns {{points: number[][], at: number[]}[]} one a foot; without instants at which it is not known
 */
export function waysOf(move, instants, feet) {
  const ways = feet.map(() => ({ points: [], at: [] }));
  for (const i of instants) {
    move(i);
    feet.forEach((foot, k) => {
      const point = foot();
      if (point === null) return;
      ways[k].points.push(point);
      ways[k].at.push(i);
    });
  }
  return ways;
}
