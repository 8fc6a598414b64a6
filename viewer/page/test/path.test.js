// The ribbon of a path, and the points it goes through, against closed forms.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ribbonEdges, ribbonTriangles, waysOf } from "../src/effects/path.js";
import { LIFT } from "../src/looks/ground_offset.js";

const UP = [0, 0, 1];

test("the edges of a ribbon lie half its width to both sides of a circle, a little above it", () => {
  const points = Array.from({ length: 200 }, (_, k) => [1e5 + 10 * Math.cos(0.01 * k), 10 * Math.sin(0.01 * k), 2]);
  const { edges, asides } = ribbonEdges(points, points.map(() => 0), 0.25, UP);
  for (let k = 1; k < points.length - 1; k++) {
    [0.25, -0.25].forEach((out, way) => {
      const [x, y, z] = edges.subarray(6 * k + 3 * way, 6 * k + 3 * way + 3);
      const radius = Math.hypot(x + points[0][0] - 1e5, y + points[0][1]);
      assert.ok(Math.abs(radius - (10 + out)) < 1e-3, `${radius}`); // right of a turn to the left is outside
      assert.ok(Math.abs(z - LIFT) < 1e-6);
      assert.ok(Math.abs(Math.hypot(...asides.subarray(6 * k + 3 * way, 6 * k + 3 * way + 3)) - 0.25) < 1e-6);
    });
  }
});

test("a ribbon keeps its direction where nothing moves, and where nothing ever moves it has one", () => {
  const { edges } = ribbonEdges([[0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0]], [0, 0, 0, 0], 0.5, UP); // prettier-ignore
  assert.deepEqual([...edges.subarray(18, 21)].map((v) => Math.round(1e3 * v) / 1e3), [1, -0.5, LIFT]);
  assert.ok(ribbonEdges([[0, 0, 0], [0, 0, 0]], [0, 0], 0.5, UP).edges.every(Number.isFinite)); // prettier-ignore
});

test("a ribbon ends where an epoch does, and begins anew with the direction of the next", () => {
  const points = [[0, 0, 0], [1, 0, 0], [50, 9, 0], [50, 8, 0], [50, 7, 0]]; // prettier-ignore
  const epochs = [3, 3, 4, 4, 4];
  const { edges } = ribbonEdges(points, epochs, 0.5, UP);
  const right = (k) => [...edges.subarray(6 * k, 6 * k + 2)].map((v) => Math.round(1e3 * v) / 1e3);
  assert.deepEqual([right(1), right(2)], [[1, -0.5], [49.5, 9]]); // prettier-ignore
  const triangles = ribbonTriangles(epochs);
  assert.equal(triangles.length, 6 * (points.length - 1)); // as many as are drawn up to an instant
  const across = (a, b) => [...Array(triangles.length / 3).keys()].filter((k) => {
    const corners = triangles.slice(3 * k, 3 * k + 3).map((edge) => edge >> 1);
    return corners.includes(a) && corners.includes(b);
  }); // prettier-ignore
  assert.deepEqual([across(0, 1), across(1, 2), across(2, 3)].map((found) => found.length), [2, 0, 2]);
});

test("instants at which a point is not known are left out of its path", () => {
  const rows = [[0, 0, 0.3], null, [2, 1, 0.5]]; // prettier-ignore
  let now = null;
  const [path, other] = waysOf((i) => (now = rows[i]), [0, 1, 2], [() => now, () => [7, 7, 7]]);
  assert.deepEqual(path, { points: [rows[0], rows[2]], at: [0, 2] });
  assert.deepEqual(other.at, [0, 1, 2]);
});
