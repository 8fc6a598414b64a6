// Displacement, stress and forces from columns, against sums by hand.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Bending } from "../src/scene/bending.js";
import { Frames } from "../src/scene/frames.js";
import { forcesOf, niceAbove, niceStep, worded } from "../src/scene/forces.js";
import { heightAt } from "../src/shapes/coil.js";

const close = (a, b) => a.forEach((x, i) => assert.ok(Math.abs(x - b[i]) < 1e-6 * Math.max(1, Math.abs(b[i])), `${a} is not ${b}`));
const BODY = {
  nodes: [[0, 0, 0], [1, 0, 0]],
  beams: [[0, 1]],
  amplitudes: ["p", "q"],
  modes: [[[0, 0], [0, 0], [1, 0]], [[0, 2], [0, 0], [-1, 0]]],
};

test("a node moves by its modes times the amplitudes, as many times as asked", () => {
  const body = new Bending(BODY);
  assert.equal(body.update((name) => ({ p: 0.5, q: 0.25 })[name], 10), "");
  close(body.displaced[0], [0, 0, 5]);
  close(body.displaced[1], [6, 0, -5]);
  assert.equal(body.update((name) => ({ p: 0.5 })[name], 10), "q");
  close(body.displaced[1], [1, 0, 0]);
});

test("the stress of a beam's end is that of its worst fibre", () => {
  const stress = { fibres: 2, rows: [[[[1, 0], [0, -8]], [[2, 2], [1, 0]]]], constant: [[[0, 1], [0, 0]]] };
  const body = new Bending({ ...BODY, stress });
  body.update((name) => ({ p: 3, q: 1 })[name], 1);
  close([...body.stress], [7, 8]); // |-8 + 1|; 2 * 3 + 2 * 1
});

test("round a tube axial stress and both bendings meet at one fibre", () => {
  const stress = { rule: "round", rows: [[[[1, 0], [3, 0], [0, 4]], [[-2, 0], [0, 0], [0, 0]]]] };
  const body = new Bending({ ...BODY, stress });
  body.update(() => 1, 1);
  close([...body.stress], [6, 2]);
});

test("where nothing is computed nothing is claimed", () => {
  const body = new Bending({ ...BODY, computed: "on" });
  assert.equal(body.update((name) => ({ p: 1, q: 1, on: 0 })[name], 1), null);
  close(body.displaced[1], [1, 0, 0]);
  for (const on of [NaN, undefined]) assert.equal(body.update((name) => ({ p: 1, q: 1, on })[name], 1), "on");
});

test("arrays of another length are refused", () => {
  assert.throws(() => new Bending({ ...BODY, modes: [1, 2, 3] }), /modes of a flexible body has 3 numbers, not 12/);
});

test("forces: apart along a line, in the axes of a frame, of a tyre", () => {
  const turned = { position: ["x", "x", "x"], quaternion: ["w", "x", "x", "w"], start: [[0, 0, 0], [1, 0, 0, 0]] };
  const frames = new Frames({ frames: { body: turned } });
  const numbers = { x: 0, w: Math.SQRT1_2, f: 7, a: 1, b: 2, c: 3, nx: 0, nz: 1 };
  const lookup = (name) => numbers[name];
  frames.update(lookup);
  const line = { name: "s", value: "f", sign: -1, between: [["ground", [0, 0, 0]], ["ground", [0, 0, 2]]] };
  /** @type {(arrow: Data) => {at: number[], vector: number[]}[]} */
  const drawn = (arrow) => {
    const found = forcesOf(arrow, frames, lookup);
    assert.ok(typeof found !== "string", String(found));
    return found;
  };
  const [second, first] = drawn(line);
  close(second.vector, [0, 0, -7]);
  close(second.at, [0, 0, 2]);
  close(first.vector, [0, 0, 7]);
  const pin = { name: "p", vector: ["a", "b", "c"], axes: "body", at: ["body", [1, 0, 0]] };
  const [force] = drawn(pin); // a quarter turn about z
  close(force.vector, [-2, 1, 3]);
  close(force.at, [0, 1, 0]);
  // Axis y, normal z: x = y cross z = earth x.
  const tyre = { contact: ["a", "b", "c"], normal: ["nx", "nx", "nz"], axis: ["nx", "nz", "nx"], forces: ["a", "b", "c"] };
  const [contact] = drawn({ name: "t", tyre });
  close(contact.vector, [1, 2, 3]);
  assert.match(String(forcesOf({ name: "lost", value: "none", between: line.between }, frames, lookup)), /'lost'.*'none'/);
});

test("round numbers and words for people", () => {
  assert.deepEqual([1, 1.01, 2, 4.9, 9, 0.013].map(niceAbove), [1, 2, 2, 5, 10, 0.02]);
  close([1, 1.99, 2, 7, 0.09].map(niceStep), [1, 1, 2, 5, 0.05]);
  assert.deepEqual([-858e3, 3e9, 2e4].map((x) => worded(x, "Pa", 3e7)), ["-0.858 MPa", "3000 MPa", "20 kPa"]);
  assert.deepEqual([2.5e8, 0, 1234, 999.7, 0.05].map((x) => worded(x, "N.m")), ["250 MN\u00b7m", "0 N\u00b7m", "1.23 kN\u00b7m", "1 kN\u00b7m", "50 mN\u00b7m"]);
});

test("a coil begins and ends with its wire on the seats, and its middle turns share the length", () => {
  const [coils, wire] = [7, 0.012];
  for (const height of [0.3, 0.2, 0.1]) {
    close([heightAt(0, coils, wire, height), heightAt(coils, coils, wire, height)], [wire / 2, height - wire / 2]);
    const pitch = heightAt(4, coils, wire, height) - heightAt(3, coils, wire, height);
    close([heightAt(5, coils, wire, height) - heightAt(4, coils, wire, height)], [pitch]);
    assert.ok(pitch >= 0.99 * wire);
  }
});
