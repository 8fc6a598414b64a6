import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { decodePage, fromPlanes } from "../src/sources/decode.js";
import { slerp } from "../src/sources/blend.js";
import { Sampler, linear, place } from "../src/sources/sampler.js";
import { Recordings, signalNames } from "../src/sources/recordings.js";
import { byUnit, found, resampled } from "../src/shell/series.js";

const near = (a, b, tolerance = 1e-12) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);

test("a time has its place between samples, at a step the later one", () => {
  assert.deepEqual(place([0, 1, 3], -1), [0, 0]);
  assert.deepEqual(place([0, 1, 3], 2), [1, 0.5]);
  assert.deepEqual(place([0, 1, 3], 1), [1, 0]);
  assert.deepEqual(place([0, 1, 3], 9), [2, 0]);
  assert.deepEqual(place([0, 1, 1, 2], 1), [2, 0]);
  assert.deepEqual(place([5], 7), [0, 0]);
});

test("a gap has no number between it and its neighbours, and they have theirs", () => {
  const data = [0, NaN, 2];
  assert.ok(Number.isNaN(linear(data, 0, 0.5)));
  assert.equal(linear(data, 0, 0), 0);
});

test("orientations go the shorter way at a constant rate, whatever the sign of the quaternion", () => {
  const about = (angle) => [Math.cos(angle / 2), 0, 0, Math.sin(angle / 2)];
  for (const sign of [1, -1]) {
    const q = slerp(about(0.2), about(1.4).map((x) => sign * x), 0.25);
    near(2 * Math.atan2(q[3], q[0]), 0.5);
  }
  const same = slerp(about(1), about(1), 0.3);
  near(Math.hypot(...same), 1);
  assert.ok(slerp([0, 0, 0, 0], about(1), 0.3).every(Number.isNaN), "four zeros are no orientation");
});

test("a run is looked up at any time, quaternions as one", () => {
  const frames = { body: { position: ["x", "y", "z"], quaternion: ["w", "a", "b", "c"] } };
  const columns = {};
  const angle = [0, 3];
  const put = (name, data) => (columns[name] = { unit: "", data });
  put("x", [0, 4, 90]);
  put("w", angle.map((a) => Math.cos(a / 2)));
  put("a", [0, 0]);
  put("b", [0, 0]);
  put("c", angle.map((a) => Math.sin(a / 2)));
  const sampler = new Sampler({ scene: { frames }, t: [0, 2, 2.5], epoch: [0, 0, 1], columns });
  sampler.at(1);
  assert.equal(sampler.lookup("x"), 2);
  near(2 * Math.atan2(sampler.lookup("c"), sampler.lookup("w")), 1.5);
  assert.equal(sampler.lookup("nothing"), undefined);
  sampler.at(2.4); // up to a reset it stands where it was last
  assert.equal(sampler.lookup("x"), 4);
  sampler.at(2.5);
  assert.equal(sampler.lookup("x"), 90);
});

test("time runs, loops and stops at the end; it passes however long a picture takes", () => {
  const over = (begin, end, options = {}) => {
    const t = new Float64Array([begin, end]);
    return new Recordings([{ scene: null, t, epoch: [0, 0], columns: {}, name: "", notes: [], missing: [] }], options);
  };
  const once = over(0, 1, { loop: false });
  once.acts.toggle();
  for (let i = 0; i < 8; i++) once.tick(0.1);
  near(once.time, 0.8, 1e-9);
  for (let i = 0; i < 3; i++) once.tick(0.1);
  assert.deepEqual([once.time, once.running], [1, false]);
  once.acts.toggle();
  assert.deepEqual([once.time, once.running], [0, true]);
  const slow = over(0, 100, { speed: 2 });
  slow.acts.toggle();
  for (let i = 0; i < 4; i++) slow.tick(0.4);
  near(slow.time, 3.2, 1e-9);
  const round = over(0, 1);
  round.acts.seek(0.95);
  round.acts.toggle();
  round.tick(0.1);
  near(round.time, 0.05, 1e-9);
  const instant = over(3, 3);
  instant.acts.toggle();
  assert.equal(instant.running, false);
});

test("planes of bytes become the numbers again", () => {
  const numbers = new Float64Array([1.5, -2e-300, NaN, 7]);
  const bytes = new Uint8Array(numbers.buffer);
  const planes = new Uint8Array(bytes.length);
  for (let i = 0; i < 4; i++) for (let b = 0; b < 8; b++) planes[b * 4 + i] = bytes[i * 8 + b];
  assert.deepEqual(fromPlanes(planes, "f8"), numbers);
});

test("a page becomes runs", async () => {
  const block = (names, kind, numbers) => {
    const bytes = new Uint8Array(numbers.buffer);
    const [size, count] = [numbers.BYTES_PER_ELEMENT, numbers.length];
    const planes = new Uint8Array(bytes.length);
    for (let i = 0; i < count; i++) for (let b = 0; b < size; b++) planes[b * count + i] = bytes[i * size + b];
    return { names, kind, data: gzipSync(planes).toString("base64") };
  };
  const run = {
    name: "run",
    scene: 0,
    time: block(["time", "epoch"], "f8", new Float64Array([0, 1, 5, 6])),
    blocks: [block(["b", "a"], "f4", new Float32Array([1, 2, 3, 4]))],
    order: ["a", "b"],
    units: { a: "m" },
    notes: [],
    missing: [],
  };
  const { runs } = await decodePage({ format: "ALi3 page", version: 1, scenes: [{ frames: {} }], runs: [run], options: {} });
  assert.deepEqual(Array.from(runs[0].columns.a.data), [3, 4]);
  assert.equal(runs[0].columns.a.unit, "m");
  assert.deepEqual([runs[0].t, runs[0].epoch].map((numbers) => Array.from(numbers)), [[0, 1], [5, 6]]); // prettier-ignore
  assert.deepEqual(Object.keys(runs[0].columns), ["a", "b"]);
  await assert.rejects(decodePage({ format: "other" }), /another format/);
});

test("signals are found by words, grouped by unit, and those of poses come last", () => {
  const columns = { "a.x": { unit: "m", data: [] }, force: { unit: "N", data: [] }, gap: { unit: "m", data: [] } };
  const scene = { frames: { a: { position: ["a.x", "a.y", "a.z"], quaternion: [] } } };
  const runs = [{ scene, columns }];
  assert.deepEqual(signalNames(runs), ["force", "gap", "a.x"]);
  assert.deepEqual(found(["wheel_FL.Fz", "wheel_FR.Fz"], "fz fl"), ["wheel_FL.Fz"]);
  assert.deepEqual([...byUnit(["gap", "force", "a.x", "none"], new Map([["a.x", "m"], ["force", "N"], ["gap", "m"]]))], [["m", ["gap", "a.x"]], ["N", ["force"]]]);
});

test("another run is compared at the times of this one", () => {
  assert.deepEqual(resampled([0, 2], [0, 4], [-1, 0, 1, 2, 3]), [null, 0, 2, 4, null]);
});
