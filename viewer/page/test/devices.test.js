import assert from "node:assert/strict";
import test from "node:test";
import { barOf, changed, chosen, drivenBy, movingWords, partOf, pressedWords, readByHost, shapeOf, sourcesFor } from "../src/simulator/device_words.js";

const DEVICE = {
  id: "g", name: "Wheel", kind: "wheel", axes: [0.1, -1, 1], buttons: [0, 1], hats: [5], force: true, force_problem: "",
  inputs: ["steering", "brake", "selector drive"], settings: { rotation: 900 }, assigning: null, calibration: null,
  mapping: {
    steering: { source: "axis 0", inverted: true, low: -1, high: 1, dead_zone: 0, centre: null, value: 0.2 },
    brake: { source: "axis 2", inverted: false, low: -0.9, high: 0.8, dead_zone: 0.03, centre: null, value: 1 },
  },
}; // prettier-ignore

test("an input can have the sources that fit it", () => {
  const axes = ["axis 0", "axis 1", "axis 2"];
  const pressed = ["button 0", "button 1", "hat 0 up", "hat 0 right", "hat 0 down", "hat 0 left"];
  assert.deepEqual(sourcesFor(DEVICE, "steering"), ["none", ...axes]);
  assert.deepEqual(sourcesFor(DEVICE, "selector drive"), ["none", ...pressed]);
  assert.deepEqual(sourcesFor(DEVICE, "brake"), ["none", ...axes, ...pressed]);
});

test("another axis keeps the direction, a button needs none, and nothing is nothing", () => {
  assert.deepEqual(chosen(DEVICE.mapping.brake, "axis 1", "brake"), { source: "axis 1", inverted: false, low: -1, high: 1, dead_zone: 0.03 });
  assert.equal(chosen(undefined, "axis 1", "steering").inverted, true);
  assert.equal(chosen({ source: "button 1", inverted: true }, "axis 1", "throttle").inverted, false);
  assert.deepEqual(chosen(DEVICE.mapping.brake, "button 1", "brake"), { source: "button 1" });
  assert.equal(chosen(DEVICE.mapping.brake, "none", "brake"), null);
});

test("what is only shown is not sent", () => {
  const sent = { source: "axis 2", inverted: true, low: -0.9, high: 0.8, dead_zone: 0.03, centre: null };
  assert.deepEqual(changed(DEVICE.mapping.brake, { inverted: true }), sent);
});

test("parts of an axis are named, and other ends are calibrated ones", () => {
  assert.deepEqual([[-1, 1], [0, 1], [-1, 0], [-0.9, 0.8]].map(([low, high]) => partOf({ low, high })), ["whole axis", "upper half", "lower half", "calibrated"]);
});

test("bars go from their rest to the value and stay inside", () => {
  assert.deepEqual(barOf(0.5, -1, 1, 0), { left: 50, width: 25 });
  assert.deepEqual(barOf(-3, -1, 1, 0), { left: 0, width: 50 });
  assert.deepEqual(barOf(0.25, 0, 1, 0), { left: 0, width: 25 });
});

test("words tell what drives and what is pressed", () => {
  assert.deepEqual([0, 1, 2].map((k) => drivenBy(DEVICE, k)), [["steering"], [], ["brake"]]);
  assert.equal(pressedWords(DEVICE), "button 1, hat 0 up, hat 0 down");
  assert.equal(pressedWords({ buttons: [0], hats: [] }), "none");
  assert.equal(movingWords("steering"), "turn the steering wheel to the left now");
  assert.equal(movingWords("selector drive"), "press the button for selector drive now");
});

test("only what changes the panel makes it new", () => {
  const moved = structuredClone(DEVICE);
  moved.axes[0] = 0.9;
  moved.buttons[0] = 1;
  moved.mapping.brake.value = 0;
  assert.equal(shapeOf(moved), shapeOf(DEVICE));
  moved.mapping.brake.dead_zone = 0.1;
  assert.notEqual(shapeOf(moved), shapeOf(DEVICE));
  assert.notEqual(shapeOf({ ...DEVICE, calibration: { stage: "rest", text: "" } }), shapeOf(DEVICE));
});

test("a gamepad of the browser that the host reads too is told by its numbers", () => {
  const devices = [{ usb: "046d:c24f" }];
  assert.ok(readByHost("G29 Racing Wheel (Vendor: 046d Product: c24f)", devices)); // as Chromium writes it
  assert.ok(readByHost("46d-c24f-Logitech G29", devices)); // as Firefox does
  assert.ok(!readByHost("Xbox 360 Controller (STANDARD GAMEPAD Vendor: 045e Product: 028e)", devices));
  assert.ok(!readByHost("Xbox 360 Controller (XInput STANDARD GAMEPAD)", devices));
});
