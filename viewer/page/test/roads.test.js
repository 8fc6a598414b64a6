// The part of a road's profile about a place, against its levels.
import assert from "node:assert/strict";
import { test } from "node:test";
import { strip, surfaces, wetness } from "../src/looks/roads.js";

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
  assert.equal(wetness(1), 0);
  assert.ok(wetness(0.8) > 0 && wetness(0.8) < wetness(0.6) && wetness(0.6) <= 0.5);
  assert.ok(wetness(0.3) > 0.5 && wetness(0.1) <= 1 && wetness(0.1) > wetness(0.3));
});

test("a kerb is its face and a stone along its upper edge", () => {
  const up = surfaces([[-9, 0], [-0.001, 0], [0.001, 0.1], [9, 0.1]]);
  assert.deepEqual(up.map(({ kerb }) => kerb), [false, true, true, false]);
  assert.deepEqual([up[2].from[0], +up[2].to[0].toFixed(6), up[3].to[0]], [0.001, 0.151, 9]);
  const down = surfaces([[-9, 0.1], [-0.001, 0.1], [0.001, 0], [9, 0]]);
  assert.deepEqual(down.map(({ kerb }) => kerb), [false, true, true, false]);
  assert.deepEqual(surfaces([[0, 0], [10, 1]]).map(({ kerb }) => kerb), [false]);
});
