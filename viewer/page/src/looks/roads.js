// Makes the roads of a scene: flat, inclined, with a profile, or a grid of heights.
import * as THREE from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { add, cross, dot, scale, subtract, unit } from "../scene/math.js";
import { floats } from "../bytes.js";
import { alongY, turn } from "../shapes/place.js";
import shared from "../../../looks.json" with { type: "json" };
import { gripOf, heldWithin, slickness } from "./heights.js";

/** Half the side of an unbounded road, m. */
const HALF_SIDE = 1500;
/**
 * Unbounded ground is divided, since processors draw large triangles with depth errors: largest distance of a division from
 * the eye, m, ratio to the next nearer one, and least distance, in sizes of the drawing.
 */
const [FARTHEST_DIVISION, DIVISION_RATIO, NEAREST_DIVISION] = [320, 4, 20];
/** Motion of the eye after which a profile is rebuilt, less than half of its middle piece, m. */
const UPDATE_DISTANCE = 10;
/** Width of the continuation of a grid beyond its border, m. */
export const { border } = shared;
/** Cells of a side of a piece of a grid; pieces outside the picture are not drawn. */
const PIECE_CELLS = 64;
/** Largest length of a drawn cell of a grid, since longer triangles have depth errors, m. */
const MAX_CELL = 20;
/** Largest number of cells along a road from this division; cells of longer roads are longer. */
const MAX_ADDED = 400;

/**
 * Makes the roads.
 * @param {Data} scene
 * @param {{up: number[], asphalt: THREE.Material, road: THREE.Material, grass: THREE.Material, extent: number, reach?: number}} looks extent:
 *   size of the drawing, m; reach: half the side of an unbounded road, m
 */
export function makeRoads(scene, looks) {
  const group = new THREE.Group();
  const pieces = [];
  const unknown = [];
  for (const road of scene.roads ?? []) {
    if (road.kind === "terrain") continue; // of a world, see world.js
    const maker = { flat: plane, plane, profile, grid }[road.kind];
    if (maker === undefined) unknown.push(`A road of the kind '${road.kind}' is not known to this page and is not drawn.`);
    else pieces.push(...maker(road, looks));
  }
  for (const { mesh } of pieces) {
    mesh.receiveShadow = true;
    group.add(mesh);
  }
  return {
    group,
    unknown,
    /** @param {number[]} origin earth position of the origin of the picture, m @param {number[]} eye camera, relative to the origin, m */
    follow(origin, eye) {
      for (const { follow } of pieces) follow(origin, eye);
    },
    /** Replaces materials. @param {(material: THREE.Material | THREE.Material[]) => THREE.Material} other */
    dress(other) {
      for (const { mesh } of pieces) mesh.material = other(mesh.material);
    },
    dispose() {
      for (const { mesh } of pieces) mesh.geometry.dispose();
    },
  };
}

/** A square on a plane through a point that follows the eye, with the friction of a road. */
function unboundedPlane(point, normal, material, road, { extent, reach = HALF_SIDE }) {
  const edges = divisions(-reach, reach, extent);
  const cells = edges.length - 1;
  const geometry = new THREE.PlaneGeometry(cells, cells, cells, cells).rotateX(-Math.PI / 2);
  const places = geometry.getAttribute("position");
  const edge = (/** @type {number} */ at) => edges[Math.round(at + cells / 2)];
  for (let k = 0; k < places.count; k++) places.setXYZ(k, edge(places.getX(k)), 0, edge(places.getZ(k)));
  cover(geometry, Array(places.count).fill(slickness(gripOf(road))).flat());
  const mesh = new THREE.Mesh(geometry, material);
  turn(mesh, alongY(normal));
  const follow = (origin, eye) =>
    mesh.position.fromArray(add(eye, scale(normal, dot(normal, subtract(point, add(origin, eye))))));
  return [{ mesh, follow }];
}

/** @param {THREE.BufferGeometry} geometry @param {number[]} slick two shares for each point, see `slickness`; the first is -1 on stone */
function cover(geometry, slick) {
  geometry.setAttribute("slick", new THREE.BufferAttribute(Float32Array.from(slick), 2));
}

/** A flat or inclined road. */
function plane(road, looks) {
  const { up, asphalt } = looks;
  return unboundedPlane(road.point ?? scale(up, road.height ?? 0), unit(road.normal ?? up) ?? up, asphalt, road, looks);
}

/** A road with a profile along a direction, level before and behind it, built around the eye. */
function profile(road, { up, asphalt: material, extent, reach = HALF_SIDE }) {
  const forward = unit(road.direction ?? [1, 0, 0]);
  const side = cross(up, forward);
  const base = road.origin ?? [0, 0, 0];
  const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
  let built = null;
  const follow = (origin, eye) => {
    const to = subtract(add(origin, eye), base);
    const [s, aside] = [dot(to, forward), road.width === undefined ? dot(to, side) : 0];
    if (built === null || Math.abs(s - built.s) > UPDATE_DISTANCE || Math.abs(aside - built.aside) > UPDATE_DISTANCE) {
      built = { s, aside, at: add(base, add(scale(forward, s), scale(side, aside))) };
      rebuild(mesh.geometry, strip(road, s, reach), { forward, side, up, half: (road.width ?? 2 * reach) / 2, slick: slickness(gripOf(road)), extent });
    }
    mesh.position.fromArray(subtract(built.at, origin));
  };
  return [{ mesh, follow }];
}

/** Height of a profile at a station. @param {{stations: number[], heights: number[]}} road @param {number} at */
export function levelOf({ stations, heights }, at) {
  const last = stations.length - 1;
  if (at <= stations[0]) return heights[0];
  if (at >= stations[last]) return heights[last];
  const i = stations.findIndex((station) => station > at) - 1;
  return heights[i] + ((at - stations[i]) / (stations[i + 1] - stations[i])) * (heights[i + 1] - heights[i]);
}

/**
 * The part of a profile around a station: pairs of relative station and height.
 * @param {{stations: number[], heights: number[]}} road @param {number} s the station, m @param {number} reach
 */
export function strip(road, s, reach) {
  const inside = road.stations.flatMap((station, i) => (Math.abs(station - s) < reach ? [[station - s, road.heights[i]]] : []));
  return [[-reach, levelOf(road, s - reach)], ...inside, [reach, levelOf(road, s + reach)]];
}

/** Width of the stone along the upper edge of a kerb, m. */
const STONE_WIDTH = 0.15;

/**
 * Surfaces between stations, and whether each is a kerb: a face steeper than 1 in 2, or its stone.
 * @param {number[][]} pairs of station and height
 */
export function surfaces(pairs) {
  const steep = (/** @type {number[]} */ [s0, h0], /** @type {number[]} */ [s1, h1]) => Math.abs(h1 - h0) > 0.5 * (s1 - s0);
  const found = [];
  for (let i = 0; i + 1 < pairs.length; i++) {
    let from = pairs[i];
    const to = pairs[i + 1];
    const kerb = steep(from, to);
    const at = (s) => [s, from[1] + ((s - from[0]) / (to[0] - from[0])) * (to[1] - from[1])];
    const long = to[0] - from[0] > 3 * STONE_WIDTH;
    if (!kerb && long && i > 0 && steep(pairs[i - 1], from) && pairs[i - 1][1] < from[1]) {
      const edge = at(from[0] + STONE_WIDTH);
      found.push({ from, to: edge, kerb: true });
      from = edge;
    }
    if (!kerb && long && i + 2 < pairs.length && steep(to, pairs[i + 2]) && pairs[i + 2][1] < to[1]) {
      const edge = at(to[0] - STONE_WIDTH);
      found.push({ from, to: edge, kerb: false }, { from: edge, to, kerb: true });
    } else found.push({ from, to, kerb });
  }
  return found;
}

/** Angle above which edges stay sharp, rad. */
const CREASE = Math.PI / 8;

/** Both ends and the divisions between them. @param {number} from @param {number} to @param {number} extent size of the drawing, m */
function divisions(from, to, extent) {
  const distances = [];
  for (let at = FARTHEST_DIVISION; at >= NEAREST_DIVISION * Math.min(extent, 1); at /= DIVISION_RATIO) distances.push(at);
  const edges = [...distances.map((at) => -at), ...distances.reverse()];
  return [from, ...edges.filter((edge) => from < edge && edge < to), to];
}

function rebuild(geometry, pairs, { forward, side, up, half, slick: road, extent }) {
  const positions = [];
  const slick = [];
  const point = ([s, level], aside) => add(add(scale(forward, s), scale(up, level)), scale(side, aside));
  const asides = divisions(-half, half, extent);
  for (const { from, to, kerb } of surfaces(pairs)) {
    const rise = (to[1] - from[1]) / (to[0] - from[0]);
    const stations = divisions(from[0], to[0], extent).map((s) => (s === to[0] ? to : [s, from[1] + rise * (s - from[0])]));
    for (let i = 0; i + 1 < stations.length; i++) {
      for (let j = 0; j + 1 < asides.length; j++) {
        const [a, b, right, left] = [stations[i], stations[i + 1], asides[j], asides[j + 1]];
        const corners = [point(a, right), point(b, right), point(b, left), point(a, left)];
        for (const k of [0, 1, 2, 0, 2, 3]) {
          positions.push(...corners[k]);
          slick.push(...(kerb ? [-1, 0] : road));
        }
      }
    }
  }
  const flatShaded = new THREE.BufferGeometry();
  flatShaded.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions), 3));
  const creased = toCreasedNormals(flatShaded, CREASE);
  geometry.dispose();
  geometry.setAttribute("position", creased.getAttribute("position"));
  geometry.setAttribute("normal", creased.getAttribute("normal"));
  cover(geometry, slick);
  geometry.computeBoundingSphere();
}

/** Earth vectors of the axes of a grid. @param {Data} road @param {number[]} up */
export const groundAxes = (road, up) => road.axes ?? (Math.abs(up[2]) > 0.5 ? [[1, 0, 0], [0, 1, 0]] : [[1, 0, 0], [0, 0, -1]]); // prettier-ignore

const everyIndex = (/** @type {number} */ n, /** @type {(k: number) => boolean} */ holds) => [...Array(n).keys()].every(holds);

/**
 * Drawn lines of a grid, without those between two equal neighbours.
 * @param {number} n number of lines @param {(k: number) => boolean} same whether a line equals the next one
 */
export function kept(n, same) {
  const equal = Array.from({ length: n - 1 }, (_, k) => same(k));
  return [...Array(n).keys()].filter((k) => k === 0 || k === n - 1 || !(equal[k - 1] && equal[k]));
}

/**
 * Lines with additional ones, so that their distance is at most `MAX_CELL`, or a share of a long road.
 * @param {number[]} lines @param {number} spacing m
 */
export function divided(lines, spacing) {
  const longest = Math.max(MAX_CELL, ((lines[lines.length - 1] - lines[0]) * spacing) / MAX_ADDED);
  return lines.flatMap((k, at) => {
    const gap = (lines[at + 1] ?? k) - k;
    const parts = Math.max(1, Math.ceil((gap * spacing) / longest));
    return Array.from({ length: parts }, (_, part) => k + (gap * part) / parts);
  });
}

/** Bilinear value on a grid, constant beyond its border. @param {Float32Array} values @param {number} ny @param {number} i @param {number} j */
export function between(values, ny, i, j) {
  [i, j] = [heldWithin(i, values.length / ny), heldWithin(j, ny)];
  const [a, b] = [Math.floor(i), Math.floor(j)];
  const along = (/** @type {number} */ column) => {
    const low = values[a * ny + column];
    return i === a ? low : low + (i - a) * (values[(a + 1) * ny + column] - low);
  };
  return j === b ? along(b) : along(b) + (j - b) * (along(b + 1) - along(b));
}

/**
 * A road on a grid, in pieces; low friction is drawn as water or ice. As for wheels, the heights of its border continue,
 * before and behind as road, at both sides as grass; around it is lower grass.
 */
function grid(road, looks) {
  const { up, road: material, grass } = looks;
  const [nx, ny] = road.shape;
  const [dx, dy] = road.spacing;
  const heights = floats(road.heights);
  const frictions = road.frictions === undefined ? null : floats(road.frictions);
  const factor = road.friction_factor ?? 1;
  const axes = groundAxes(road, up);
  const world = (x, y, z) => add(add(scale(axes[0], x), scale(axes[1], y)), scale(up, z));
  const pieces = [];
  const same = (/** @type {number} */ a, /** @type {number} */ b) => heights[a] === heights[b] && frictions?.[a] === frictions?.[b];
  const along = divided([-border / dx, ...kept(nx, (k) => everyIndex(ny, (j) => same(k * ny + j, (k + 1) * ny + j))), nx - 1 + border / dx], dx);
  const aside = divided(kept(ny, (k) => everyIndex(nx, (i) => same(i * ny + k, i * ny + k + 1))), dy);
  const [right, left] = [[-border / dy, 0], [ny - 1, ny - 1 + border / dy]].map((ends) => divided(ends, dy)); // prettier-ignore
  const addSheet = (/** @type {number[]} */ across, /** @type {THREE.Material} */ look, /** @type {(friction: (values: Float32Array) => number) => number[]} */ slickOf) => {
    for (let i0 = 0; i0 < along.length - 1; i0 += PIECE_CELLS) {
      for (let j0 = 0; j0 < across.length - 1; j0 += PIECE_CELLS) {
        const [i1, j1] = [Math.min(i0 + PIECE_CELLS, along.length - 1), Math.min(j0 + PIECE_CELLS, across.length - 1)];
        const [positions, slick, triangles] = [[], [], []];
        for (let i = i0; i <= i1; i++) {
          for (let j = j0; j <= j1; j++) {
            const value = (/** @type {Float32Array} */ values) => between(values, ny, along[i], across[j]);
            positions.push(...world((along[i] - along[i0]) * dx, (across[j] - across[j0]) * dy, value(heights)));
            slick.push(...slickOf(value));
          }
        }
        const row = j1 - j0 + 1;
        for (let i = 0; i < i1 - i0; i++) {
          for (let j = 0; j < j1 - j0; j++) {
            const a = i * row + j;
            triangles.push(a, a + row, a + 1, a + 1, a + row, a + row + 1);
          }
        }
        pieces.push(piece(world(road.origin[0] + along[i0] * dx, road.origin[1] + across[j0] * dy, 0), positions, triangles, slick, look));
      }
    }
  };
  addSheet(aside, material, (value) => slickness(frictions === null ? gripOf(road) : factor * value(frictions)));
  for (const side of [right, left]) addSheet(side, grass, () => [0, 0]);
  const low = heights.reduce((a, b) => Math.min(a, b), Infinity);
  pieces.push(...unboundedPlane(scale(up, low - 0.15), up, grass, {}, looks));
  return pieces;
}

function piece(at, positions, triangles, slick, material) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions), 3));
  geometry.setIndex(triangles);
  geometry.computeVertexNormals();
  cover(geometry, slick);
  const mesh = new THREE.Mesh(geometry, material);
  return { mesh, follow: (origin) => mesh.position.fromArray(subtract(at, origin)) };
}
