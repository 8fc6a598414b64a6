import assert from "node:assert/strict";
import test from "node:test";
import { Blend } from "../src/sources/blend.js";
import { Engine, scriptAt } from "../src/live/engine.js";
import { Gamepad, readSource, withDeadZone } from "../src/live/gamepad.js";
import { LimitedInputs } from "../src/live/input_rates.js";
import { realTimeText } from "../src/sources/factor.js";
import { Keyboard } from "../src/live/keyboard.js";
import { RealTimeClock } from "../src/live/real_time_clock.js";
import { choicesOf, fromSlider, rangeOf, toSlider } from "../src/live/ranges.js";
import { between, Record } from "../src/live/record.js";
import { movedRoads } from "../src/live/roads.js";
import { missingParts } from "../src/common/browser_support.js";
import { Runner } from "../src/live/worker.js";

test("a pacer keeps absolute deadlines: a late wake makes up for what it missed", () => {
  const pacer = new RealTimeClock(0.002);
  pacer.start(100, 0, 1);
  assert.equal(pacer.due(100.0019), 0);
  assert.equal(pacer.due(100.1), 50);
  pacer.reached(100.1, 50);
  assert.equal(pacer.due(101), 500);
  assert.ok(Math.abs(pacer.deadline(500) - 101) < 1e-9);
  assert.equal(pacer.slow, 0);
});

test("a pacer tells a machine that does not keep up, and slow motion is none", () => {
  const pacer = new RealTimeClock(0.01);
  pacer.start(0, 0, 1);
  for (let n = 1; n <= 300; n++) pacer.reached(0.01 * n, Math.floor(0.4 * n)); // 0.4 of real time
  assert.ok(Math.abs(pacer.factor - 0.4) < 0.02, String(pacer.factor));
  assert.ok(pacer.slow > 0);
  const words = { running: true };
  assert.match(realTimeText({ ...words, speed: 1, factor: pacer.factor }).warn, /does not keep up: 0\.40 s of the run a second, 1 asked/);
  assert.equal(realTimeText({ ...words, speed: 0.1, factor: 0.1 }).warn, "");
  assert.match(realTimeText({ ...words, speed: 0.1, factor: 0.1 }).text, /slow motion/);
  pacer.start(10, 120, 0.5);
  assert.equal(pacer.due(11), 120 + 50);
});

test("a hand moves at a limited rate and reaches what is wanted exactly", () => {
  const hand = new LimitedInputs([0, 1]);
  hand.want(0, 0.3, 2);
  const seen = [];
  for (let n = 0; n < 4; n++) seen.push(hand.move(0.05)[0]);
  assert.deepEqual(seen.map((v) => v.toFixed(9)), ["0.100000000", "0.200000000", "0.300000000", "0.300000000"]);
  assert.equal(hand.values[0], 0.3);
  hand.want(1, -1);
  assert.equal(hand.move(0.05)[1], -1);
});

test("keys steer less the faster the car is, to the left positive", () => {
  const keys = new Keyboard({ "vehicle.wheelbase": 2.3, "vehicle.front_wheel_angle_max": 0.525 });
  assert.equal(keys.steeringLimit(1), 1);
  assert.ok(Math.abs(keys.steeringLimit(20) - (9 * 2.3) / 400 / 0.525) < 1e-12);
  assert.deepEqual(keys.key("KeyA", true), { used: true });
  assert.deepEqual(keys.key("KeyQ", true), { used: false });
  const wants = Object.fromEntries(keys.wants(0).map(([name, value]) => [name, value]));
  assert.deepEqual(wants, { steering: 1, throttle: 0, brake: 0, hand_brake: 0 });
  keys.key("KeyD", true);
  assert.equal(keys.wants(0)[0][1], 0);
  assert.equal(keys.key("KeyR", true).selector, -1);
  assert.equal(keys.key("KeyN", true).selector, 0);
  assert.equal(keys.key("KeyD", true, true).selector, 1);
});

test("a gamepad is found when plugged in; sticks have a dead zone, pedals a whole travel", () => {
  let pads = [];
  const pad = new Gamepad(() => pads);
  assert.deepEqual(pad.poll(), { changed: false, touched: false });
  const device = { id: "wheel", mapping: "standard", axes: [0, 0], buttons: Array.from({ length: 8 }, () => ({ value: 0 })) };
  pads = [null, device];
  assert.deepEqual(pad.poll(), { changed: true, touched: false });
  device.axes = [-0.5, 0];
  device.buttons[7] = { value: 0.75 };
  assert.deepEqual(pad.poll(), { changed: false, touched: true });
  const wants = Object.fromEntries(pad.wants());
  assert.ok(Math.abs(wants.steering - (0.5 - 0.08) / 0.92) < 1e-12); // stick to the left: positive
  assert.equal(wants.throttle, 0.75);
  assert.equal(withDeadZone(0.05, 0.08), 0);
  assert.equal(withDeadZone(-1, 0.08), -1);
  const pedals = { axes: [0, -1, 1], buttons: [] };
  assert.equal(readSource(pedals, "axis 0", true, 0.05), 0); // never moved yet
  assert.equal(readSource(pedals, "axis 1", true, 0.05), 0);
  assert.equal(readSource(pedals, "axis 2", true, 0.05), 1);
  assert.equal(readSource(pedals, "axis 1 inverted", true, 0.05), 1);
  pads = [];
  assert.equal(pad.poll().changed, true);
  assert.deepEqual(pad.wants(), []);
});

test("sliders: the given range, a guess that says so, logarithmic where it is wide, whole numbers", () => {
  const pedal = rangeOf({ min: 0, max: 1, start: 0, type: "Real", unit: "1" });
  assert.deepEqual([pedal.low, pedal.high, pedal.guessed, pedal.log], [0, 1, false, false]);
  const torque = rangeOf({ start: 0, type: "Real", unit: "N.m" });
  assert.deepEqual([torque.low, torque.high, torque.guessed], [-100, 100, true]);
  const tiny = rangeOf({ start: -1.4e-16, type: "Real", unit: "N.m" });
  assert.deepEqual([tiny.low, tiny.high], [-100, 100]);
  const moved = rangeOf({ start: 0, type: "Real", unit: "N.m", largest: 3.7 });
  assert.deepEqual([moved.low, moved.high], [-8, 8]);
  const half = rangeOf({ min: 5, start: 0, type: "Real", unit: "m" });
  assert.deepEqual([half.low, half.high], [5, 25]);
  const spring = rangeOf({ min: 1e3, max: 9e5, start: 12360, type: "Real", unit: "N/m" });
  assert.equal(spring.log, true);
  for (const value of [1e3, 12360, 9e5]) assert.ok(Math.abs(fromSlider(spring, toSlider(spring, value)) / value - 1) < 1e-3);
  assert.equal(fromSlider(spring, 1), 9e5);
  const selector = { min: -1, max: 1, type: "Integer", description: "selector: -1 reverse, 0 neutral, 1 drive" };
  assert.equal(fromSlider(rangeOf(selector), 0.4), 0);
  assert.deepEqual(choicesOf(selector), [[-1, "-1 reverse"], [0, "0 neutral"], [1, "1 drive"]]);
  assert.equal(choicesOf({ min: 0, max: 100, type: "Integer" }), null);
});

test("a record: rows in blocks, cut, thinned, as a table, and a picture between two rows", () => {
  const record = new Record(["u"], ["x", "angle"], 0.1, 8 * 1024 * 3 * 3);
  record.add([0], [0, 3]);
  for (let k = 1; k < 2100; k++) record.add([k - 1], [10 * k, k % 2 ? -3.1 : 3.1]);
  assert.equal(record.row(1200)[0], 1200); // the input of the step that begins there
  const at = between(record, 120.05, new Blend(null, [{ name: "angle", unit: "rad" }]), new Map([["x", 1], ["angle", 2]]));
  assert.ok(Math.abs(at("x") - 12005) < 1e-6);
  assert.ok(Math.abs(Math.abs(at("angle")) - Math.PI) < 1e-9); // the short way, not through nought
  assert.deepEqual(record.series(1, 2000, 50)[1], [20000, 20500, 20990]);
  record.cut(1100);
  assert.equal(record.time, 110);
  record.add([7], [5, 5]);
  assert.deepEqual([...record.row(1101)], [7, 5, 5]);
  for (let k = record.end; k < 5000; k++) record.add([k], [k, 0]);
  assert.equal(record.first, 2048); // the oldest blocks were forgotten
  assert.equal(record.row(4998)[1], 4998);
  const table = new Record(["u"], ["x"], 0.5);
  table.add([0], [1]);
  table.add([-0], [1 / 3]);
  assert.equal(table.csv(["start: a=1"]).join(""), '"time","u","x"\n0,-0,1\n0.5,-0,0.3333333333333333\n# start: a=1\n');
});

/** An FMU of a mass pushed by u, which refuses to pass x = 1. */
function mass() {
  const variables = new Map(
    [
      { name: "u", causality: "input", variability: "continuous", type: "Real", start: 0 },
      { name: "k", causality: "parameter", variability: "tunable", type: "Real", start: 1 },
      { name: "x", causality: "output", variability: "continuous", type: "Real" },
    ].map((v) => [v.name, v]),
  );
  const instantiate = () => {
    const slave = { messages: [], freed: 0, sets: 0 };
    slave.reset = () => (slave.s = { u: 0, k: 1, x: 0, v: 0 });
    slave.reset();
    slave.set = (values) => Object.assign(slave.s, values);
    slave.initialise = () => {};
    slave.writer = ([name]) => ([value]) => {
      slave.sets += 1;
      slave.s[name] = value;
    };
    slave.reader = () => () => [slave.s.x];
    slave.getState = () => ({ s: { ...slave.s }, free: () => (slave.freed += 1) });
    slave.setState = ({ s }) => (slave.s = { ...s });
    slave.step = (h) => {
      const v = slave.s.v + h * slave.s.k * slave.s.u;
      if (slave.s.x + h * v > 1) throw Object.assign(new Error("x is beyond 1"), { status: "discard" });
      Object.assign(slave.s, { v, x: slave.s.x + h * v });
    };
    slave.free = () => {};
    return slave;
  };
  return { variables, instantiate };
}

test("an engine goes back bit for bit and drives on, sets what changed only, and stops at a refused step", () => {
  const engine = new Engine([mass()], 0.01);
  engine.restart({ u: 0.1 });
  engine.hand.want(0, 0.9, 0.5);
  const seen = [engine.rows[0]];
  for (let n = 0; n < 80; n++) {
    if (n === 40) engine.hand.want(1, 2);
    assert.deepEqual(engine.advance(), []);
    seen.push(engine.rows[0]);
  }
  engine.back(37); // between two saved states
  assert.equal(engine.rows[0], seen[37]);
  assert.equal(engine.hand.values[1], 1);
  engine.hand.want(0, 0.9, 0.5);
  engine.hand.want(1, 1);
  for (let n = 37; n < 40; n++) engine.advance();
  engine.hand.want(1, 2);
  for (let n = 40; n < 80; n++) engine.advance();
  assert.equal(engine.rows[0], seen[80]);
  let refused = [];
  while (!refused.length) refused = engine.advance();
  assert.deepEqual([refused[0].text, engine.alive], ["x is beyond 1", false]);
  const k = engine.k;
  engine.hand.want(0, -1e4);
  engine.retry();
  for (let n = 0; n < 5; n++) engine.advance();
  assert.ok(engine.k > k);
  engine.restart({});
  assert.deepEqual([engine.k, engine.rows[0], engine.alive], [0, 0, true]);
});

test("where one of two refuses, the other goes on; going back wakes it", () => {
  const other = mass();
  const engine = new Engine([mass(), other], 0.01);
  engine.restart({ u: 1 });
  engine.runs[1].slave.s.x = 0.5; // is there earlier
  let [refused, steps] = [[], 0];
  for (; !refused.length; steps++) refused = engine.advance();
  assert.equal(refused[0].which, 1);
  assert.equal(engine.k, steps); // the other has made this one
  assert.equal(engine.alive, true);
  const [at, stays] = [engine.k, engine.rows[1]];
  for (let n = 0; n < 10; n++) engine.advance();
  assert.equal(engine.rows[1], stays);
  engine.back(at + 5);
  assert.notEqual(engine.runs[1].failed, null);
  engine.back(at - 3);
  assert.equal(engine.runs[1].failed, null);
  assert.ok(engine.rows[1] < stays);
});

test("what a browser lacks is one sentence", () => {
  assert.equal(missingParts({ WebAssembly: {}, DecompressionStream: class {} }), "");
  assert.match(missingParts({ DecompressionStream: class {} }), /^This browser has no WebAssembly.*\.$/);
  assert.match(missingParts({ WebAssembly: {} }), /^This browser has no DecompressionStream.*\.$/);
});

test("a script moves inputs until a hand takes them, and begins with its first row", () => {
  const script = { t: [0, 1, 1, 2], columns: { u: [0.5, 1.5, -1, 0], gear: [1, 2, 3, 3] } };
  const at = (time) => Object.values(scriptAt(script, time, new Set(["gear"])));
  assert.deepEqual([at(-1), at(0.5), at(1), at(1.5), at(9)], [[0.5, 1], [1, 1], [-1, 3], [-0.5, 3], [0, 3]]);
  const engine = new Engine([mass()], 0.25);
  engine.script = { t: [0, 1], columns: { u: [0.1, 0.5] } };
  engine.restart({});
  const seen = [];
  for (let n = 0; n < 3; n++) seen.push((engine.advance(), engine.held[0]));
  engine.want("u", -0.2);
  for (let n = 0; n < 2; n++) seen.push((engine.advance(), engine.held[0]));
  assert.deepEqual(seen, [0.1, 0.2, 0.30000000000000004, -0.2, -0.2]);
  assert.equal(engine.runs[0].slave.sets, 3);
});

test("a kerb stands where the parameters have it, down as it was drawn", () => {
  const kerb = { kind: "profile", stations: [0, 0.001], heights: [0, -0.08], direction: [1, 0, 0], origin: [1e6, 0, 0] };
  const road = { ...kerb, variables: { kerb_x: "road.kerb_x", kerb_height: "road.kerb_height" } };
  const at = (x, h) => movedRoads([road], (name) => (name.endsWith("x") ? x : h));
  const [moved] = at(20, 0.1).roads;
  assert.deepEqual([moved.origin, moved.heights], [[20, 0, 0], [0, -0.1]]);
  assert.notEqual(at(20, 0.1).key, at(21, 0.1).key);
  assert.deepEqual(movedRoads([kerb], () => 5).roads, [kerb]);
});

test("a road is as slick as the parameters have it", () => {
  const road = { kind: "flat", friction: 1, variables: { friction: "f", friction_factor: "c" } };
  const at = (factor) => movedRoads([road], (name) => (name === "c" ? factor : undefined));
  assert.deepEqual(at(0.1).roads, [{ ...road, friction_factor: 0.1 }]);
  assert.notEqual(at(0.1).key, at(0.2).key);
});

test("an FMU that has broken is loaded again when it begins again", async () => {
  const loads = [];
  const messages = [];
  const runner = new Runner((message) => messages.push(message));
  runner._load = async (step) => {
    const fmu = mass();
    loads.push(fmu);
    runner.engine = new Engine([fmu], step);
  };
  await runner.take({ do: "open", fmus: [], step: 0.01, start: {} });
  await runner.take({ do: "restart", start: {} });
  assert.equal(loads.length, 1);
  loads[0].broken = "a trap";
  await runner.take({ do: "restart", start: { u: 1 } });
  assert.equal(loads.length, 2);
  await runner.take({ do: "step", count: 3 });
  assert.deepEqual(messages.map((message) => message.is), ["started", "started", "started", "paused"]);
  assert.equal(messages.at(-1).count, 3);
  await runner.take({ do: "back", k: 1 });
  assert.deepEqual([messages.at(-1).is, messages.at(-1).k], ["back", 1]);
});

test("an FMU that could not begin says why again when it is to run, in a sentence, and can be begun again", async () => {
  const messages = [];
  const runner = new Runner((message) => messages.push(message));
  const description = { modelName: "Odd", guid: "", variables: [] };
  await runner.take({ do: "open", fmus: [{ wasm: new Uint8Array(4), description }], step: 0.01, start: {} });
  await runner.take({ do: "want", wants: [["u", 1]] });
  await runner.take({ do: "run", speed: 1 });
  assert.equal(messages.length, 2);
  assert.match(messages[0].text, /^The binary of the FMU Odd for wasm32 cannot be loaded: /);
  assert.deepEqual(messages[1], messages[0]);
  runner._load = async (step) => {
    runner.engine = new Engine([mass()], step);
  };
  await runner.take({ do: "restart", start: {}, step: 0.01 });
  await runner.take({ do: "step", count: 2 });
  assert.deepEqual(messages.slice(2).map((message) => message.is), ["started", "paused"]);
});
