// The terrain and the paint on it, against heights in closed form.
import assert from "node:assert/strict";
import { test } from "node:test";
import { borderQuads, borderStations, straightened } from "../src/looks/terrain_border.js";
import { HeightField, SURFACES, SurfaceRaster, surfaceOf } from "../src/looks/heights.js";
import { arrowStrips, dashes, edges } from "../src/looks/scenery/ribbon.js";
import { squares } from "../src/looks/scenery/index.js";
import { shares } from "../src/looks/coverage.js";
import { lines } from "../src/looks/scenery/signs.js";
import { bundles, parts, pieceParts, strided } from "../src/looks/terrain_mesh.js";

const base64 = (array) => Buffer.from(array.buffer).toString("base64");

function patch(origin, spacing, shape, height) {
  const heights = new Float32Array(shape[0] * shape[1]);
  for (let i = 0; i < shape[0]; i++) {
    for (let j = 0; j < shape[1]; j++) heights[i * shape[1] + j] = height(origin[0] + i * spacing[0], origin[1] + j * spacing[1]);
  }
  return { origin, spacing, shape, heights: base64(heights) };
}
const plane = (x, y) => 0.1 * x - 0.05 * y + 2;
/** A fine patch beside a coarse one. */
const PAIR = { kind: "terrain", patches: [patch([0, 0], [0.5, 0.5], [21, 21], plane), patch([10, 0], [2, 5], [6, 3], plane)] };

test("heights and slopes of a plane are those of the plane, over the seam too", () => {
  const field = new HeightField(PAIR);
  for (const [x, y] of [[0.3, 0.7], [9.9, 5], [10, 5], [10.1, 5.2], [19, 9.3]]) {
    assert.ok(Math.abs(field.at(x, y) - plane(x, y)) < 1e-5);
    const [a, b] = field.slope(Math.min(17, Math.max(2, x)), 5);
    assert.ok(Math.abs(a - 0.1) < 1e-4 && Math.abs(b + 0.05) < 1e-4);
  } // prettier-ignore
  assert.ok(Math.abs(field.at(500, -70) - plane(20, 0)) < 1e-5);
});

test("pieces cover every cell once, at each coarseness, and face up", () => {
  const field = new HeightField(PAIR);
  const list = parts(field.patches, 8);
  let area = 0;
  for (const part of list) {
    const { positions, base, parts: [{ levels }] } = pieceParts([part], field); // prettier-ignore
    for (const { triangles, count, error } of levels) {
      assert.equal(count, triangles.length / 3);
      let sum = 0;
      for (let t = 0; t < triangles.length; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => positions.subarray(3 * triangles[t + k], 3 * triangles[t + k] + 3));
        const turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert.ok(turn > -1e-6);
        sum += turn / 2;
      }
      const { patch: of, n, m } = part;
      assert.ok(Math.abs(sum - (n - 1) * (m - 1) * of.spacing[0] * of.spacing[1]) < 1e-3);
      assert.ok(error < 1e-5); // of a plane
    }
    for (let k = 0; k < part.n * part.m; k++) {
      const [x, y, z] = positions.subarray(3 * k, 3 * k + 3);
      assert.ok(Math.abs(z - plane(base[0] + x, base[1] + y)) < 1e-5);
    }
    area += (part.n - 1) * (part.m - 1) * part.patch.spacing[0] * part.patch.spacing[1];
  }
  assert.equal(area, 200);
});

test("both sides of a seam are lit alike", () => {
  const hilly = (x, y) => 0.5 * Math.sin(0.3 * x) + 0.2 * Math.cos(0.4 * y);
  const field = new HeightField({ patches: [patch([0, 0], [1, 1], [11, 11], hilly), patch([10, 0], [2, 2], [6, 6], hilly)] });
  const normals = new Map();
  for (const part of parts(field.patches, 64)) {
    const { base, positions, normals: found } = pieceParts([part], field);
    for (let k = 0; k < part.n * part.m; k++) {
      const key = [base[0] + positions[3 * k], base[1] + positions[3 * k + 1]].join();
      const normal = [...found.subarray(3 * k, 3 * k + 3)];
      if (normals.has(key)) normals.get(key).forEach((value, axis) => assert.ok(Math.abs(value - normal[axis]) < 1e-6));
      normals.set(key, normal);
    }
  }
  assert.equal(normals.size, 11 * 11 + 6 * 6 - 6);
});

test("what is left out far away is off by what its level says", () => {
  const wave = (x) => 0.2 * Math.sin((2 * Math.PI * x) / 8);
  const field = new HeightField({ patches: [patch([0, 0], [1, 1], [17, 3], wave)] });
  const [{ levels }] = pieceParts(parts(field.patches, 64), field).parts;
  assert.equal(levels[0].error, 0);
  assert.ok(Math.abs(levels[1].error - 0.2 * (Math.SQRT1_2 - 0.5)) < 1e-6); // between a zero and a crest
  assert.ok(levels.every(({ error }, k) => k === 0 || error >= levels[k - 1].error - 1e-6));
  assert.deepEqual(strided(10, 4), [0, 4, 8, 9]);
});

test("many small patches become few pieces, none lost", () => {
  const list = [];
  for (let a = 0; a < 20; a++) for (let b = 0; b < 20; b++) list.push(patch([8 * a, 8 * b], [1, 1], [9, 9], plane));
  const field = new HeightField({ patches: list });
  const meshes = bundles(parts(field.patches, 128), 50, 60000);
  assert.ok(meshes.length <= 50);
  assert.equal(meshes.flat().length, 400);
});

test("beyond the border its heights go on, around the focus and far away", () => {
  const field = new HeightField(PAIR);
  const stations = borderStations(field);
  /** @type {(low: number[], high: number[], at: number[]) => boolean} */
  const inside = ([x0, y0], [x1, y1], [x, y]) => x >= x0 && x <= x1 && y >= y0 && y <= y1;
  for (const centre of [[5, 5], [90000, -50000], [-3000, 4]]) {
    const quads = borderQuads(field, stations, centre);
    for (const [dx, dy] of [[0, 0], [1200, 300], [-900, -1100], [40, 1300]]) {
      const at = [centre[0] + dx + 0.25, centre[1] + dy + 0.25];
      const on = quads.filter(([a, , c]) => inside(a, c, at));
      const within = inside(field.low, field.high, at);
      assert.equal(on.length, within ? 0 : 1);
      if (within) continue;
      const [a, b, c, d] = on[0];
      const [u, v] = [(at[0] - a[0]) / (c[0] - a[0]), (at[1] - a[1]) / (c[1] - a[1])];
      const drawn = (1 - u) * (1 - v) * a[2] + u * (1 - v) * b[2] + u * v * c[2] + (1 - u) * v * d[2];
      assert.ok(Math.abs(drawn - field.at(at[0], at[1])) < 1e-5);
    }
  } // prettier-ignore
});

test("a border keeps the places at which it bends", () => {
  const places = Array.from({ length: 101 }, (_, k) => k);
  const bend = (/** @type {number} */ x) => Math.max(0, x - 40) * 0.1 - Math.max(0, x - 70) * 0.1;
  assert.deepEqual(straightened(places, bend, 1e-6), [0, 40, 70, 100]);
  const kept = straightened(places, (x) => Math.sin(0.1 * x), 0.01);
  assert.ok(kept.length < 40);
  kept.slice(1).forEach((b, k) => {
    const a = kept[k];
    for (let x = a; x < b; x++) {
      const line = Math.sin(0.1 * a) + ((x - a) / (b - a)) * (Math.sin(0.1 * b) - Math.sin(0.1 * a));
      assert.ok(Math.abs(Math.sin(0.1 * x) - line) <= 0.01);
    }
  });
  assert.deepEqual(straightened([0, 1], bend, 0), [0, 1]);
});

test("a surface has the name of its nearest cell, and its border goes on", () => {
  const surface = { origin: [0, 0], spacing: [1, 2], shape: [2, 2], classes: base64(new Uint8Array([0, 1, 2, 0])), names: ["asphalt", "wet", "grass"] };
  const raster = new SurfaceRaster(surface);
  assert.equal(raster.nameAt(0.4, 0.9), "asphalt");
  assert.equal(raster.nameAt(0.4, 1.1), "wet");
  assert.equal(raster.nameAt(0.6, 0.9), "grass");
  assert.equal(raster.nameAt(-99, 99), "wet");
  // Rows along x: wet is the second of the first row, grass the first of the second; 25 of 36 parts of it stay there.
  const { pixels } = shares(raster);
  const near = (at, share) => assert.ok(Math.abs(pixels[at] - 128 - (127 * share) / 36) <= 2, `${at}: ${pixels[at]}`);
  near(4 + 2, 25);
  near(8 + 1, 25);
  near(4 + 1, 1);
  assert.equal(surfaceOf({ roads: [{ kind: "flat" }] })(0, 0), "asphalt");
  assert.throws(() => new SurfaceRaster({ ...surface, shape: [3, 2] }), /3 x 2/);
});

test("a large raster is averaged", () => {
  const classes = new Uint8Array(16).fill(1, 0, 8);
  const raster = new SurfaceRaster({ origin: [0, 0], spacing: [1, 1], shape: [4, 4], classes: base64(classes), names: ["asphalt", "grass"] });
  const { width, height, factor, pixels } = shares(raster, 2);
  assert.deepEqual([width, height, factor], [2, 2, 2]);
  // A sixth of what is beside goes over the edge: of grass, and of asphalt.
  assert.deepEqual([0, 1, 2, 3].map((k) => pixels[4 * k + 1]), [234, 234, 149, 149]);
  assert.deepEqual([0, 1, 2, 3].map((k) => pixels[4 * k]), [149, 149, 234, 234]);
});

test("of two surfaces that share a channel one is above the middle and the other below it", () => {
  const classes = Uint8Array.from({ length: 8 }, (_, k) => k);
  for (const [k, name] of SURFACES.entries()) {
    const one = { origin: [0, 0], spacing: [1, 1], shape: [1, 1], classes: base64(classes.slice(k, k + 1)), names: SURFACES };
    const expected = [128, 128, 128, 128];
    expected[k < 4 ? k : 7 - k] += k < 4 ? 127 : -63;
    assert.deepEqual([...shares(new SurfaceRaster(one)).pixels], expected, name);
    const halves = { ...one, shape: [1, 2], classes: base64(Uint8Array.of(k, 7 - k)) };
    assert.equal(shares(new SurfaceRaster(halves), 1).pixels[Math.min(k, 7 - k)], 160, `half ${name} is not neither`);
  }
});

const length = (stretch) => stretch.slice(1).reduce((sum, b, k) => sum + Math.hypot(b[0] - stretch[k][0], b[1] - stretch[k][1]), 0);

test("dashes are as long as asked, over corners too", () => {
  const found = dashes([[0, 0, 0], [10, 0, 0], [10, 20, 0]], [3, 6]); // prettier-ignore
  assert.deepEqual(found.map((stretch) => Math.round(1e3 * length(stretch)) / 1e3), [3, 3, 3, 3]);
  assert.deepEqual(found[1].map(([x, y]) => [Math.round(x * 1e3) / 1e3, Math.round(y * 1e3) / 1e3]), [[9, 0], [10, 0], [10, 2]]); // prettier-ignore
  assert.equal(dashes([[0, 0, 0], [10, 0, 0]]).length, 1); // prettier-ignore
});

test("a line lies on the ground, as wide as asked, with few points where it is straight", () => {
  const field = new HeightField(PAIR);
  const pairs = edges([[1, 3, 0], [19, 3, 0]], 0.2, field); // prettier-ignore
  assert.ok(pairs.length <= 5);
  for (const [right, left] of pairs) {
    assert.ok(Math.abs(left[1] - right[1] - 0.2) < 1e-9);
    for (const [x, y, z] of [right, left]) assert.ok(Math.abs(z - plane(x, y) - 0.004) < 1e-5);
  }
  const bent = edges([[0, 0, 1], [5, 0, 1], [5, 5, 1]], 0.2, null); // prettier-ignore
  assert.deepEqual(bent[1].map((point) => point.map((value) => Math.round(1e6 * value) / 1e6)), [[5.1, -0.1, 1.004], [4.9, 0.1, 1.004]]);
});

test("an arrow is as long as asked and points along its yaw", () => {
  const points = arrowStrips({ at: [1, 2, 0], yaw: Math.PI / 2, length: 4 }, null).flat(2);
  const y = points.map((point) => point[1]);
  assert.ok(Math.abs(Math.max(...y) - 4) < 1e-9 && Math.abs(Math.min(...y)) < 1e-9);
  const tip = points.filter((point) => Math.abs(point[1] - 4) < 1e-9);
  assert.ok(tip.every(([x]) => Math.abs(x - 1) < 1e-9));
});

test("things are gathered by places, in few squares", () => {
  const things = Array.from({ length: 900 }, (_, k) => ({ kind: "cone", at: [100 * (k % 30), 100 * Math.floor(k / 30), 0] }));
  const found = squares(things);
  assert.equal(found.flat().length, 900);
  assert.ok(found.length <= 36);
});

test("words of a sign stand in at most three lines, all of them", () => {
  assert.deepEqual(lines("20 %"), ["20 %"]);
  assert.equal(lines("double lane change").join(" "), "double lane change");
  const long = "split friction with a wet lane on the left side";
  assert.equal(lines(long).join(" "), long);
  assert.equal(lines(long).length, 3);
});
