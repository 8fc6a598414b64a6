// The part of a road's profile about a place, against its levels.
import assert from "node:assert/strict";
import { test } from "node:test";
import { slickness, surfaceOf } from "../src/looks/heights.js";
import { roadHeight } from "../src/looks/road_height.js";
import { between, divided, kept, strip, surfaces } from "../src/looks/roads.js";

const KERB = { stations: [-0.5, 0.5], heights: [0, 0.1] };

test("about a step both levels go on to the end", () => {
  assert.deepEqual(strip(KERB, 0, 100), [[-100, 0], [-0.5, 0], [0.5, 0.1], [100, 0.1]]);
});

test("far before and far behind the step there is one level", () => {
  assert.deepEqual(strip(KERB, -1e6, 100), [[-100, 0], [100, 0]]);
  assert.deepEqual(strip(KERB, 1e6, 100), [[-100, 0.1], [100, 0.1]]);
});

test("an end between two stations has the level between", () => {
  const ramp = { stations: [0, 100, 200], heights: [0, 10, 0] };
  assert.deepEqual(strip(ramp, 100, 75), [[-75, 2.5], [0, 10], [75, 2.5]]);
});

test("a friction is dry, wet or ice, the slipperier the more", () => {
  const near = (factor, film, ice) => slickness(factor).forEach((share, k) => assert.ok(Math.abs(share - [film, ice][k]) < 1e-12));
  for (const [factor, film, ice] of [[1.3, 0, 0], [0.95, 0, 0], [0.725, 0.5, 0], [0.5, 1, 0], [0.35, 1, 0.5], [0.1, 1, 1]]) near(factor, film, ice);
});

test("a road with one friction is that everywhere, and dry where nothing is said", () => {
  const at = (road) => surfaceOf({ roads: [{ kind: "flat", ...road }] })(5, 6);
  assert.deepEqual([at({}), at({ friction: 0.6 }), at({ friction: 0.1 }), at({ friction_factor: 0.2 })], ["asphalt", "wet", "ice", "ice"]);
});

test("what lies at a place of a grid follows its frictions, and its border goes on", () => {
  const frictions = btoa(String.fromCharCode(...new Uint8Array(new Float32Array([1, 0.6, 0.2, 1, 0.6, 0.2]).buffer)));
  const grid = { kind: "grid", origin: [0, -1], spacing: [10, 1], shape: [2, 3], heights: frictions, frictions };
  const at = surfaceOf({ roads: [grid] });
  assert.deepEqual([-9, -0.6, -0.4, 0.4, 0.6, 9].map((y) => at(3, y)), ["asphalt", "asphalt", "wet", "wet", "ice", "ice"]);
  assert.equal(surfaceOf({ roads: [{ ...grid, friction_factor: 0.5 }] })(3, -9), "wet");
  assert.equal(surfaceOf({ roads: [{ ...grid, frictions: undefined }] })(3, 9), "asphalt");
});

test("a kerb is its face and a stone along its upper edge", () => {
  const up = surfaces([[-9, 0], [-0.001, 0], [0.001, 0.1], [9, 0.1]]);
  assert.deepEqual(up.map(({ kerb }) => kerb), [false, true, true, false]);
  assert.deepEqual([up[2].from[0], +up[2].to[0].toFixed(6), up[3].to[0]], [0.001, 0.151, 9]);
  const down = surfaces([[-9, 0.1], [-0.001, 0.1], [0.001, 0], [9, 0]]);
  assert.deepEqual(down.map(({ kerb }) => kerb), [false, true, true, false]);
  assert.deepEqual(surfaces([[0, 0], [10, 1]]).map(({ kerb }) => kerb), [false]);
});

test("the ground below a point is that of the highest road there", () => {
  const up = [0, 0, 1];
  const near = (roads, point, expected, axis = up) => assert.ok(Math.abs(roadHeight(roads, axis, point) - expected) < 1e-6);
  near([{ kind: "flat", height: 0.3 }], [5, 6, 7], 0.3);
  near([{ kind: "plane", point: [0, 0, 1], normal: [-0.6, 0, 0.8] }], [4, 9, 2], 1 + 4 * 0.75);
  near([{ kind: "profile", direction: [0, 2, 0], origin: [0, 10, 0.5], ...KERB }], [3, 10.25, 0], 0.5 + 0.075);
  const grid = { kind: "grid", origin: [1, 2], spacing: [0.5, 2], shape: [2, 3], heights: [0, 1, 2, 4, 5, 6] };
  near([grid], [1.125, 5, 0], 2.5);
  near([grid], [1.5, 6, 0], 6);
  near([grid, { kind: "flat" }], [0, 0, 5], 0);
  near([grid], [1.125, 9, -5], 2.5, [0, 1, 0]);
  near([grid], [30, 5, 0], 5.5); // its border goes on
  for (const point of [[-29.1, 2, 0], [1.5, 36.1, 0]]) assert.equal(roadHeight([grid], up, point), null);
  assert.equal(roadHeight([{ kind: "file" }], up, [0, 0, 0]), null);
});

test("lines of a grid between two equal neighbours are left out, its ends and every change stay", () => {
  const values = [1, 1, 1, 1, 2, 3, 3, 3, 1];
  assert.deepEqual(kept(values.length, (k) => values[k] === values[k + 1]), [0, 3, 4, 5, 7, 8]); // prettier-ignore
  assert.deepEqual(kept(2, () => true), [0, 1]); // prettier-ignore
});

test("cells of a grid are at most 20 m long, and lines between those of the grid lie straight between them", () => {
  assert.deepEqual(divided([0, 1, 3], 25), [0, 0.5, 1, 1 + 2 / 3, 1 + 4 / 3, 3]);
  assert.deepEqual(divided([0, 40, 41], 0.5), [0, 40, 41]);
  assert.equal(divided([0, 1], 1e5).length, 401); // of 100 km
  const values = Float32Array.from([0, 10, 4, 18]); // prettier-ignore
  assert.deepEqual([[0, 1], [0.5, 0], [0, 0.25], [0.5, 0.5], [1, 1]].map(([i, j]) => between(values, 2, i, j)), [10, 2, 2.5, 8, 18]); // prettier-ignore
});
