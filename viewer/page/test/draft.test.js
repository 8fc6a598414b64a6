// Drafts: fewer triangles of the same form, coarser ground, and the choice of the level by measured times.
import assert from "node:assert/strict";
import { test } from "node:test";
import { levelsWithin, ROUGH } from "../src/looks/terrain.js";
import { thinned, within } from "../src/looks/draft/vertex_clustering.js";
import { nextLevel, nextShare, PictureQuality } from "../src/looks/picture_quality.js";
import { coilTriangles } from "../src/shapes/coil.js";

/** A closed ball of squares cut in two, with outward normals. */
function ball(radius, n) {
  const surface = { positions: [], normals: [], colours: [], index: [] };
  for (let i = 0; i <= n; i++) {
    for (let j = 0; j <= 2 * n; j++) {
      const [a, b] = [(Math.PI * i) / n, (Math.PI * j) / n];
      const normal = [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
      surface.positions.push(...normal.map((value) => radius * value));
      surface.normals.push(...normal);
      surface.colours.push(1, 0, 0);
      const at = i * (2 * n + 1) + j;
      if (i < n && j < 2 * n) surface.index.push(at, at + 2 * n + 1, at + 1, at + 1, at + 2 * n + 1, at + 2 * n + 2);
    }
  }
  return surface;
}

function volume({ positions, index }) {
  const at = (k) => [positions[3 * k], positions[3 * k + 1], positions[3 * k + 2]];
  let sum = 0;
  for (let k = 0; k < index.length; k += 3) {
    const [[a, b, c], [d, e, f], [g, h, i]] = [at(index[k]), at(index[k + 1]), at(index[k + 2])];
    sum += (a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) / 6;
  }
  return sum;
}

test("a thinned ball has few triangles, its points on the ball and its volume", () => {
  const fine = ball(1, 60);
  const coarse = thinned(fine, 0.2);
  assert.ok(coarse.index.length < fine.index.length / 8);
  const exact = (4 / 3) * Math.PI;
  assert.ok(Math.abs(volume(fine) / exact - 1) < 0.005);
  assert.ok(Math.abs(volume(coarse) / exact - 1) < 0.06, `${volume(coarse) / exact}`);
  for (let k = 0; k < coarse.positions.length; k += 3) {
    const place = coarse.positions.slice(k, k + 3);
    const far = Math.hypot(...place);
    assert.ok(far < 1 + 1e-9 && far > 0.97);
    const along = place.reduce((sum, value, i) => sum + value * coarse.normals[k + i], 0);
    assert.ok(along > 0.9 * far);
  }
});

test("surfaces together keep to a number of triangles, and stay as they are where they do", () => {
  const balls = [ball(1, 40), ball(0.1, 40)];
  const mesh = within(balls, 1500, 0.01);
  const count = mesh.reduce((sum, { index }) => sum + index.length / 3, 0);
  assert.ok(count <= 1500 && count > 400);
  assert.equal(within(balls, 1e6, 0.01), balls);
});

test("the two sides of a thin sheet keep their own normals", () => {
  const side = (z) => [[0, 0, z], [1, 0, z], [1, 1, z], [0, 1, z]]; // prettier-ignore
  const positions = [...side(0.001), ...side(-0.001)].flat();
  const normals = [...Array(4).fill([0, 0, 1]), ...Array(4).fill([0, 0, -1])].flat();
  const sheet = thinned({ positions, normals, colours: Array(24).fill(0.5), index: [0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6] }, 0.1);
  assert.equal(sheet.index.length, 12);
  assert.deepEqual([...new Set(sheet.normals.filter((_, k) => k % 3 === 2))].sort(), [-1, 1]);
});

test("ground is drawn the more coarsely the farther away, never off by more than is allowed", () => {
  const levels = [0, 0.005, 0.05, 0.2].map((error) => ({ error, count: 0 }));
  const piece = [0, 10, 20, 500].map((far) => ({ middle: [far, 0], radius: 0, levels }));
  assert.deepEqual(levelsWithin([piece], [0, 0], ROUGH), [[1, 1, 2, 3]]);
});

test("ground of more triangles than a picture may have is coarser where it is far, not near", () => {
  const levels = [0, 0.02, 0.1, 0.4, 1.6].map((error, k) => ({ error, count: 4 ** (4 - k) }));
  const piece = Array.from({ length: 20 }, (_, k) => ({ middle: [20 * k, 0], radius: 5, levels }));
  const count = (/** @type {number[][]} */ chosen) => chosen.flat().reduce((sum, level) => sum + levels[level].count, 0);
  const [free, bound] = [1e9, 800].map((most) => levelsWithin([piece, piece], [0, 0], { ...ROUGH, most }));
  assert.ok(count(free) > 800 && count(bound) <= 800 && count(bound) > 400);
  assert.ok(free.every((row, k) => row.every((level, i) => level <= bound[k][i])));
  assert.equal(bound[0][0], free[0][0]);
});

test("a level that is too slow gets coarser, a draft that is quick gets finer; only what is driven is drafted", () => {
  assert.equal(nextLevel("high", 100, false), "medium");
  assert.equal(nextLevel("medium", 100, false), "medium");
  assert.equal(nextLevel("medium", 100, true), "low");
  assert.equal(nextLevel("low", 100, true), "draft");
  assert.equal(nextLevel("draft", 100, true), "draft");
  assert.equal(nextLevel("draft", 5, true), "low");
  assert.equal(nextLevel("draft", 20, true), "draft");
  assert.equal(nextLevel("high", 10, true), "high");
});

test("a coarse wire uses points of the fine one, from its first to its last ring", () => {
  const [fine, coarse] = [coilTriangles(6), coilTriangles(6, 2)];
  assert.ok(coarse.length < fine.length / 4);
  assert.equal(Math.floor(Math.max(...coarse) / 7), Math.floor(Math.max(...fine) / 7));
});

/** A pace whose pictures take times of its own; gives what it chose after so many pictures. */
function paced(t, driven, quality, timeOf, between = 5) {
  let clock = 0;
  let reads = 0;
  t.mock.method(performance, "now", () => clock);
  const gl = { readPixels: () => (reads += 1) };
  const pace = new PictureQuality(/** @type {any} */ ({ getContext: () => gl }), quality, { software: true, driven });
  const draw = (pictures) => {
    for (let k = 0; k < pictures; k++) {
      pace.before();
      clock += timeOf(pace);
      pace.after();
      clock += between;
    }
    return [pace.level, Number(pace.share.toFixed(2)), reads];
  };
  return draw;
}

test("a draft that is driven loses pixels where it is too slow and gets them back; a level that was tried is not tried again", (t) => {
  let world = 60; // ms a picture at all pixels; a finer level takes thrice as long
  const draw = paced(t, true, "auto", ({ level, share }) => (level === "draft" ? 1 : 3) * world * share * share);
  assert.deepEqual(draw(8), ["draft", 0.8, 5]);
  assert.deepEqual(draw(200).slice(0, 2), ["draft", 0.8]); // 38 ms
  world = 200;
  assert.deepEqual(draw(400).slice(0, 2), ["draft", 0.5]);
  world = 11;
  assert.equal(draw(800)[1], 1);
  assert.equal(draw(800)[0], "low"); // 33 ms
  world = 60;
  assert.deepEqual(draw(400).slice(0, 2), ["draft", 0.8]);
  world = 11;
  const [level, share, before] = draw(2000);
  assert.deepEqual([level, share], ["draft", 1]);
  assert.equal(draw(1000)[2] - before, 50); // one of twenty waits for the card
});

test("a draft whose pictures are quick but seldom loses pixels too, and one that stands still does not", (t) => {
  assert.deepEqual(paced(t, true, "auto", () => 20, 40)(400).slice(0, 2), ["draft", 0.5]); // 60 ms from one to the next
  t.mock.restoreAll();
  assert.deepEqual(paced(t, true, "auto", () => 20, 30)(400).slice(0, 2), ["draft", 1]);
  t.mock.restoreAll();
  assert.deepEqual(paced(t, true, "auto", () => 20, 500)(400).slice(0, 2), ["draft", 1]);
});

test("a quality that was chosen stays, and what stands still is measured once", (t) => {
  assert.deepEqual(paced(t, true, "low", () => 500)(500), ["low", 1, 0]);
  t.mock.restoreAll();
  assert.deepEqual(paced(t, false, "auto", () => 500)(500), ["medium", 1, 0]);
  assert.deepEqual([nextShare(1, 41), nextShare(0.5, 90), nextShare(0.8, 20), nextShare(0.8, 10)], [0.8, 0.5, 0.8, 1]);
});
