// The poses of frames against closed forms.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Frames } from "../src/scene/frames.js";
import { aboutAxis, axesOfPoints, fromQuaternion, product, rotate, toQuaternion, transpose } from "../src/scene/math.js";

const close = (a, b, within = 1e-12) => a.forEach((x, i) => assert.ok(Math.abs(x - b[i]) <= within, `${a} is not ${b}`));
const columns = (names) => ({ position: names.slice(0, 3), quaternion: names.slice(3) });
const BODY = columns(["x", "y", "z", "qw", "qx", "qy", "qz"]);

test("a quaternion turns as Rodrigues' formula says, whatever its length", () => {
  const u = [2 / 7, 3 / 7, 6 / 7];
  const angle = 1.234;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const v = [0.3, -1.1, 0.7];
  const along = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const expected = v.map((x, i) => x * c + cross[i] * s + u[i] * along * (1 - c));
  const q = [Math.cos(angle / 2), ...u.map((x) => x * Math.sin(angle / 2))].map((x) => 3 * x);
  close(rotate(fromQuaternion(q), v), expected);
  close(rotate(aboutAxis([2, 3, 6], angle), v), expected);
});

test("a quaternion and its rotation are each other's inverse in all four branches", () => {
  for (const q of [[0.5, 0.5, 0.5, 0.5], [0.1, 0.9, -0.3, 0.2], [0.1, 0.2, 0.9, -0.3], [0.05, -0.3, 0.2, 0.9]]) {
    const n = Math.hypot(...q);
    close(toQuaternion(fromQuaternion(q)), q.map((x) => x / n));
  }
  assert.equal(fromQuaternion([0, 0, 0, 0]), null);
});

test("a rack slides along a line of its parent", () => {
  const chassis = { position: ["x", "y", "z"], quaternion: ["qw", "qx", "qy", "qz"] };
  const rack = { parent: "chassis", at: [1, 0, 0], direction: [0, 1, 0], way: "way" };
  const frames = new Frames({ frames: { rack, chassis } });
  const half = Math.SQRT1_2; // a quarter turn about z: y of the chassis is -x of the earth
  const now = { x: 10, y: 20, z: 30, qw: half, qx: 0, qy: 0, qz: half, way: 0.25 };
  frames.update((name) => now[name]);
  const found = frames.point("rack", [0, 0, 0.5]);
  [9.75, 21, 30.5].forEach((value, k) => assert.ok(Math.abs(found[k] - value) < 1e-12));
  frames.update((name) => (name === "way" ? undefined : now[name]));
  assert.equal(frames.point("rack", [0, 0, 0]), null);
  assert.match(frames.pose("rack").why, /'way'/);
});

test("a frame of columns, a wheel turned about the axis of its carrier, a body held at three points", () => {
  const scene = {
    frames: {
      rod: { points: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], on: [["chassis", [1, 0, 0]], ["chassis", [1, 1, 0]], ["wheel", [0, 0, 0]]] },
      wheel: { parent: "chassis", at: [0, 2, 0], axis: [0, 1, 0], angle: "phi" },
      chassis: BODY,
    },
  };
  const frames = new Frames(scene);
  // The chassis stands at (10, 20, 30), a quarter turn about z.
  const numbers = { x: 10, y: 20, z: 30, qw: Math.SQRT1_2, qx: 0, qy: 0, qz: Math.SQRT1_2, phi: Math.PI / 2 };
  frames.update((name) => numbers[name]);
  close(frames.point("chassis", [1, 2, 3]), [8, 21, 33]);
  // Wheel: centre (0, 2, 0) of the chassis; a quarter turn about its y takes x to -z.
  close(frames.point("wheel", [0, 0, 0]), [8, 20, 30]);
  close(frames.point("wheel", [1, 0, 0]), [8, 20, 29]);
  // Rod: origin at chassis (1, 0, 0) = earth (10, 21, 30), x axis along the chassis' y = earth -x.
  close(frames.point("rod", [0, 0, 0]), [10, 21, 30]);
  close(frames.point("rod", [1, 0, 0]), [9, 21, 30]);
  // y: from the origin to the wheel's centre (8, 20, 30), across x.
  close(frames.point("rod", [0, 1, 0]), [10, 20, 30]);
});

test("100 km from the origin nothing is lost", () => {
  const frames = new Frames({ frames: { far: BODY } });
  const numbers = { x: 1e5, y: -1e5, z: 0, qw: 1, qx: 0, qy: 0, qz: 0 };
  frames.update((name) => numbers[name]);
  close(frames.point("far", [1e-6, 0, 0]), [1e5 + 1e-6, -1e5, 0], 1e-10);
});

test("what has no number is hidden and says which column; what hangs on it too", () => {
  const frames = new Frames({ frames: { a: BODY, b: { parent: "a", axis: [0, 0, 1], angle: "phi" } } });
  const numbers = { x: 1, y: NaN, z: 0, qw: 1, qx: 0, qy: 0, qz: 0, phi: 1 };
  frames.update((name) => numbers[name]);
  assert.equal(frames.pose("a").shown, false);
  assert.match(frames.pose("a").why, /'y'/);
  assert.equal(frames.point("b", [0, 0, 0]), null);
  frames.update((name) => (name === "y" ? 5 : numbers[name]));
  close(frames.point("b", [0, 0, 0]), [1, 5, 0]);
});

test("frames that hang on each other in a circle are refused", () => {
  assert.throws(() => new Frames({ frames: { a: { parent: "b" }, b: { parent: "a" } } }), /circle: a, b, a/);
});

test("three points on a line have no axes", () => {
  assert.equal(axesOfPoints([0, 0, 0], [1, 0, 0], [2, 0, 0]), null);
  close(product(axesOfPoints([0, 0, 0], [0, 2, 0], [-1, 5, 0]), transpose(axesOfPoints([0, 0, 0], [0, 2, 0], [-1, 5, 0]))), [1, 0, 0, 0, 1, 0, 0, 0, 1]);
});
