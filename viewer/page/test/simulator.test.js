import assert from "node:assert/strict";
import test from "node:test";
import { Blend } from "../src/sources/blend.js";
import { InputArbiter } from "../src/live/input_arbiter.js";
import { TrailingDirection } from "../src/scene/trailing_direction.js";
import { Beat, Frames } from "../src/sources/frames.js";
import { gearWords } from "../src/instruments/cluster.js";
import { Trail } from "../src/instruments/trail.js";
import { WorldPlan } from "../src/instruments/world_plan.js";
import { Factor } from "../src/sources/factor.js";
import { Surfaces, frictionOf } from "../src/instruments/surfaces.js";
import { useColour, wheelsOf } from "../src/instruments/tyres.js";
import { besides } from "../src/common/labels.js";
import { cameraActs } from "../src/common/views.js";
import { InputRequests } from "../src/sources/input_requests.js";

const frame = (time, more = {}) => ({ epoch: 1, running: true, speed: 1, count: Math.round(time / 0.002), time, values: [time], ...more });

/** Frames each `every` s that come `late(k)` s after their time; pictures at 60 Hz. */
function played({ every, late, seconds = 4, speed = 1 }) {
  const frames = new Frames();
  const coming = [];
  for (let k = 0; k * every < seconds; k++) coming.push({ at: k * every + late(k), time: speed * k * every });
  coming.sort((a, b) => a.at - b.at);
  const shown = [];
  for (let now = 0; now < seconds; now += 1 / 60) {
    while (coming.length && coming[0].at <= now) {
      const { at, time } = coming.shift();
      frames.add(frame(time, { speed }), at);
    }
    const picture = frames.at(now);
    if (picture) shown.push({ now, ...picture, newest: frames.newest.time });
  }
  return { frames, shown };
}

test("pictures run evenly although frames come unevenly, and a little behind", () => {
  let seed = 1;
  const random = () => (seed = (16807 * seed) % 2147483647) / 2147483647;
  const { frames, shown } = played({ every: 1 / 60, late: () => 0.005 + 0.02 * random() });
  const settled = shown.filter(({ now }) => now > 2);
  const strides = settled.slice(1).map((p, k) => p.time - settled[k].time);
  assert.ok(Math.min(...strides) > 0.7 / 60 && Math.max(...strides) < 1.3 / 60, `${Math.min(...strides)} ${Math.max(...strides)}`);
  assert.ok(frames.delay > 0.015 && frames.delay < 0.05, String(frames.delay));
  assert.ok(settled.every(({ time, newest }) => time <= newest), "extrapolated");
  assert.ok(settled.every(({ time, before, after }) => before.time <= time && time <= after.time));
  assert.equal(settled.at(-1).stalled, 0);
});

test("few frames need a longer delay, slow motion runs as slowly as it is asked for", () => {
  const few = played({ every: 0.08, late: () => 0.01 });
  assert.ok(few.frames.delay > 0.07 && few.frames.delay < 0.12, String(few.frames.delay));
  const { shown } = played({ every: 1 / 60, late: () => 0.01, speed: 0.1 });
  const [a, b] = [shown.at(-61), shown.at(-1)];
  assert.ok(Math.abs((b.time - a.time) / (b.now - a.now) - 0.1) < 0.01);
});

test("nothing stands between two epochs, and a picture is not of before", () => {
  const frames = new Frames();
  for (let k = 0; k < 30; k++) frames.add(frame(5 + k / 60), k / 60);
  frames.at(0.5);
  assert.equal(frames.add(frame(2, { epoch: 2, values: [-1] }), 0.51), true);
  const now = frames.at(0.52);
  assert.equal(now.time, 2);
  assert.deepEqual([now.before.epoch, now.after.epoch], [2, 2]);
  assert.equal(frames.add(frame(2.1, { epoch: 2 }), 0.53), false);
  frames.add(frame(1.0, { epoch: 2, count: 3 }), 0.54); // an older one that was on its way
  assert.equal(frames.newest.time, 2.1);
});

test("a stall shows the last state and says so; what is paused does not stall", () => {
  const frames = new Frames();
  for (let k = 0; k <= 60; k++) {
    frames.add(frame(k / 60), k / 60);
    frames.at(k / 60);
  }
  let seen = null;
  for (let now = 1; now < 2; now += 1 / 60) seen = frames.at(now);
  assert.equal(seen.time, 1);
  assert.ok(seen.stalled > 0.9 && seen.stalled < 1.1, String(seen.stalled));
  frames.add(frame(1, { running: false }), 2);
  for (let now = 2; now < 3; now += 1 / 60) seen = frames.at(now);
  assert.equal(seen.stalled, 0);
  frames.add(frame(1.002, { running: false }), 3); // a single step
  assert.equal(frames.at(3.01).time, 1.002);
});

test("a page that was busy itself does not say that nothing comes", () => {
  const frames = new Frames();
  for (let k = 0; k <= 60; k++) frames.add(frame(k / 60), k / 60);
  frames.at(1);
  assert.equal(frames.at(1.6).stalled, 0); // one picture took 0.6 s
});

test("between frames: quaternions turn the short way, angles too, turns are counted, whole numbers jump", () => {
  const names = ["x", "yaw", "spin", "gear", "qw", "qx", "qy", "qz"];
  const scene = { frames: { body: { position: ["x"], quaternion: ["qw", "qx", "qy", "qz"] }, wheel: { angle: "spin" } } };
  const blend = new Blend(scene, [{ name: "yaw", unit: "rad" }, { name: "gear", type: "Integer" }]);
  const half = 0.1;
  const a = [0, 3.1, 100, 2, Math.cos(half), 0, 0, Math.sin(half)];
  const b = [2, -3.1, 108, 3, -Math.cos(3 * half), 0, 0, -Math.sin(3 * half)];
  const numbers = (row) => (name) => row[names.indexOf(name)];
  const at = blend.lookup(numbers(a), numbers(b), 0.25);
  assert.equal(at("x"), 0.5);
  assert.ok(Math.abs(at("yaw") - (3.1 + 0.25 * (2 * Math.PI - 6.2))) < 1e-12);
  assert.equal(at("spin"), 102);
  assert.equal(at("gear"), 2);
  const turned = 2 * Math.atan2(at("qz"), at("qw"));
  assert.ok(Math.abs(turned - (2 * half + 0.25 * 4 * half)) < 1e-12, String(turned));
  assert.equal(at("no such column"), undefined);
});

test("the gear between two rows is that of the nearer one, and no number is told as none", () => {
  const words = (numbers) => gearWords((name) => numbers[name], { selector: "selector", gear: "gear" });
  assert.deepEqual([1.4, 1.6, NaN].map((gear) => words({ selector: 1, gear })), ["gear 1", "gear 2", "gear –"]);
  assert.deepEqual([-1, -0.6, -0.4, 0.4, 0.6].map((selector) => words({ selector, gear: 1 })), ["R", "R", "N", "N", "gear 1"]);
});

test("wishes are told with all that their source holds; after a new start the selector is the car's", () => {
  const sent = [];
  const wants = new InputRequests({ want: (source, values) => sent.push([source, structuredClone(values)]) });
  wants.want("keys", [["steering", 0.50004, 1.6], ["selector", -1]]); // prettier-ignore
  wants.want("keys", [["throttle", 1, 2.5]]);
  wants.want("gamepad", [["steering", -0]]);
  assert.deepEqual(sent[1], ["keys", { steering: [0.5, 1.6], selector: [-1, null], throttle: [1, 2.5] }]);
  assert.deepEqual(sent[2], ["gamepad", { steering: [0, null] }]);
  wants.renew();
  sent.length = 0;
  wants.again();
  assert.deepEqual(sent, [["keys", { steering: [0.5, 1.6], throttle: [1, 2.5] }], ["gamepad", { steering: [0, null] }]]);
});

test("hands: keys that are let go and a gamepad that is pulled out leave nothing pressed", () => {
  const asked = [];
  let pads = [{ id: "pad", mapping: "standard", connected: true, axes: [-0, 0], buttons: Array.from({ length: 8 }, () => ({ value: 0 })) }];
  const inputs = ["steering", "throttle", "brake"];
  const hands = new InputArbiter({ inputs, constants: {}, pads: () => pads, want: (source, wants) => asked.push([source, Object.fromEntries(wants)]) });
  hands.key({ code: "KeyW", type: "keydown" }, 0);
  assert.deepEqual(asked.at(-1), ["keys", { steering: 0, throttle: 1, brake: 0 }]);
  hands.letKeysGo();
  assert.equal(asked.at(-1)[1].throttle, 0);
  hands.poll(0);
  pads[0].buttons[7] = { value: 0.8 };
  hands.poll(0);
  assert.deepEqual(asked.at(-1), ["gamepad", { steering: 0, throttle: 0.8, brake: 0 }]);
  pads = [];
  assert.equal(hands.poll(0).lost, true);
  assert.deepEqual(asked.at(-1), ["gamepad", { steering: 0, throttle: 0, brake: 0 }]);
  const count = asked.length;
  assert.equal(hands.poll(0).lost, false);
  assert.equal(asked.length, count);
});

test("keys ask for cameras: wheels in turn, the map from above, the next one", () => {
  const names = ["chase", "orbit", "side", "wheel FL", "wheel FR", "map"];
  const chosen = ["chase"];
  const acts = cameraActs(names, () => chosen.at(-1), (name) => chosen.push(name));
  for (const act of ["camera wheel", "camera wheel", "camera wheel", "camera top", "next camera"]) acts[act]();
  assert.deepEqual(chosen.slice(1), ["wheel FL", "wheel FR", "wheel FL", "map", "chase"]);
});

test("figures: factor by the host's clock, pictures a second, tyres by name, colours from green to red", () => {
  const factor = new Factor();
  let found = null;
  for (let k = 0; k < 100; k++) found = factor.add({ epoch: 1, running: true, speed: 1, time: 0.008 * k, wall: 50 + 0.01 * k });
  assert.ok(Math.abs(found - 0.8) < 1e-9);
  assert.equal(factor.add({ epoch: 1, running: false, speed: 1, time: 1, wall: 60 }), null);
  const beat = new Beat();
  for (let k = 0; k < 50; k++) beat.tick(0.04 * k + (k > 40 ? 0.2 : 0));
  assert.ok(Math.abs(beat.longest - 0.24) < 1e-9);
  assert.ok(beat.rate > 18 && beat.rate < 23);
  const slow = new Beat();
  for (const t of [0, 2, 4]) slow.tick(t);
  assert.ok(slow.longest === 2 && Math.abs(slow.rate - 0.5) < 1e-9); // seconds a picture
  assert.deepEqual(wheelsOf(["speed", "wheel_FL.Fz", "wheel_RR.Fz", "wheel_RR.Fx"]), ["wheel_FL", "wheel_RR"]);
  assert.equal(useColour(0), "rgb(64,150,90)");
  assert.equal(useColour(1.4), "rgb(232,60,45)");
  assert.equal(useColour(NaN), useColour(0));
});

test("a trail is thinned and breaks where the car was put elsewhere", () => {
  const trail = new Trail();
  for (let k = 0; k < 100; k++) trail.add(0.1 * k, 0);
  assert.ok(trail.points.length >= 6 && trail.points.length <= 7);
  trail.lift();
  trail.lift();
  trail.add(100, 100);
  trail.add(NaN, 0);
  assert.deepEqual(trail.points.slice(-2), [null, [100, 100]]);
  const lifts = [[1, 1], [1.1, 1], [3, 1], [3.1, 1], [2, 1], [2.1, 1], [2.2, 2]].map(([time, epoch], k) => {
    trail.at(time, epoch, 0.5);
    const lifted = trail.points.at(-1) === null;
    trail.add(10 * k, 0);
    return lifted;
  });
  assert.deepEqual(lifts, [false, false, true, false, true, false, true], "a jump ahead, one back, another epoch");
});

test("friction of the ground where a world tells it", () => {
  const classes = btoa(String.fromCharCode(0, 0, 0, 1, 1, 1));
  const surface = { origin: [10, -1], spacing: [2, 1], shape: [2, 3], classes, names: ["asphalt", "wet"], frictions: [1.1, 0.3] };
  const surfaces = new Surfaces([{ kind: "terrain", patches: [], surface }, { kind: "flat" }]);
  assert.equal(surfaces.friction(10.2, 0.4), 1.1);
  assert.equal(surfaces.friction(11.8, -1), 0.3);
  assert.equal(surfaces.friction(20, 0), 0.3); // beyond the border it goes on
  assert.ok(Number.isNaN(new Surfaces([{ kind: "flat" }]).friction(0, 0)));
});

test("what a tyre can hold: friction of the road, of its axle's curves on a road of friction 1, and its grip", () => {
  const variables = Object.entries({ "road.friction": 0.8, "road.friction_factor": 0.5, "rear.tyre.grip": 1.5 });
  const constants = { "vehicle.tyre_friction_front": 1.25, "vehicle.tyre_friction_rear": 0.9 };
  const known = new Map([...variables, ...Object.entries(constants)]);
  const flat = new Surfaces([{ kind: "flat" }]);
  const near = (found, expected) => assert.ok(Math.abs(found - expected) < 1e-12, `${found} for ${expected}`);
  near(frictionOf(flat, (name) => known.get(name), [0, 0], "wheel_FL"), 0.8 * 0.5 * 1.25);
  near(frictionOf(flat, (name) => known.get(name), [0, 0], "wheel_RR"), 0.8 * 0.5 * 0.9 * 1.5);
  assert.ok(Number.isNaN(frictionOf(flat, (name) => new Map(variables).get(name), [0, 0], "wheel_FR"))); // not known
});

test("a trailing direction follows a turn with its lag, stays level, and jumps with the car", () => {
  let now = 0;
  const trailing = new TrailingDirection(0.2, () => now);
  const up = [0, 0, 1];
  const angle = (/** @type {number[]} */ [x, y]) => Math.atan2(y, x);
  assert.deepEqual(trailing.along([1, 0, 0], up), [1, 0, 0]);
  now += 0.02;
  assert.ok(angle(trailing.along([Math.cos(0.3), Math.sin(0.3), 0], up)) < 0.05);
  for (let k = 0; k < 10; k++, now += 0.02) trailing.along([Math.cos(0.3), Math.sin(0.3), 0], up);
  const [x, y, z] = trailing.direction;
  assert.ok(Math.abs(angle([x, y]) - 0.3 * (1 - Math.exp(-1.0))) < 0.02, String(angle([x, y])));
  assert.ok(z === 0 && Math.abs(Math.hypot(x, y) - 1) < 1e-12);
  trailing.snap();
  assert.deepEqual(trailing.along([0, 1, 0], up), [0, 1, 0]);
  assert.deepEqual(new TrailingDirection(0).along([0, -1, 0], up), [0, -1, 0]);
});

test("words stand beside their dots, over no others, within the picture, and stay where they are", () => {
  const labels = [[400, 100], [430, 104], [434, 90], [790, 300], [2, 310], [400, 100]].map((at) => ({ at, size: [90, 14] })); // prettier-ignore
  const spots = besides(labels, [800, 400]);
  spots.forEach(({ left, top }, k) => {
    assert.ok(left >= 0 && left + 90 <= 800);
    assert.ok(Math.abs(top + 7 - labels[k].at[1]) < 60);
    for (const other of spots.slice(k + 1)) assert.ok(Math.abs(left - other.left) > 89 || Math.abs(top - other.top) >= 13.5);
  });
  assert.deepEqual([spots[0].left, spots[0].top], [400 - 8 - 90, 93]); // to the left: a dot is to the right
  assert.equal(besides([{ ...labels[0], spot: "-1 1" }], [800, 400])[0].spot, "-1 1");
  assert.equal(besides([{ ...labels[0], spot: "-1 1" }], [800, 400], [[300, 60, 400, 93]])[0].spot, "1 0");
});

test("a map shows cones however small, and a plain road as a road without a border", () => {
  const drawn = { /** @type {number[][]} */ arcs: [], /** @type {number[][]} */ borders: [] };
  const context = {
    beginPath() {},
    fill() {},
    arc: (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ radius) => drawn.arcs.push([x, y, radius]),
    strokeRect: (/** @type {number[]} */ ...border) => drawn.borders.push(border),
  };
  const scenery = [{ kind: "cone", at: [3, 4, 0] }, { kind: "post", at: [5, 6, 0] }]; // prettier-ignore
  const plain = new WorldPlan({ roads: [{ kind: "plane" }], scenery });
  plain.drawGround(/** @type {any} */ (context), 2);
  assert.deepEqual(drawn.arcs, [[3, 4, 2]]);
  assert.deepEqual(drawn.borders, []);
  new WorldPlan({ scenery }, { bounds: [-9, -9, 9, 9] }).drawGround(/** @type {any} */ (context), 0.1);
  assert.deepEqual(drawn.arcs.slice(1), [[3, 4, 0.3], [5, 6, 0.2]]); // prettier-ignore
  assert.deepEqual(drawn.borders, [[-9, -9, 18, 18]]);
  const [red, green, blue] = plain.colour.match(/[0-9a-f]{2}/g).map((part) => Number.parseInt(part, 16));
  assert.ok(Math.max(red, green, blue) - Math.min(red, green, blue) < 16, "grey");
});
