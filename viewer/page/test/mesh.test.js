// The orientation of a mesh.
import assert from "node:assert/strict";
import { test } from "node:test";
import { insideOut } from "../src/shapes/mesh.js";

const POINTS = Float32Array.from([5, 5, 5, 6, 5, 5, 5, 6, 5, 5, 5, 6]); // a tetrahedron away from the origin
const OUTWARD = Uint32Array.from([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);

test("a closed mesh looks outwards or inwards, wherever it lies", () => {
  assert.equal(insideOut(POINTS, OUTWARD), false);
  assert.equal(insideOut(POINTS, OUTWARD.slice().reverse()), true);
});
