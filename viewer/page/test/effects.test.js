// Marks, dust and the signals of sound against closed forms.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Cloud, KINDS, thrown } from "../src/effects/cloud.js";
import { CarMix } from "../src/effects/sound/mix.js";
import * as signals from "../src/effects/sound/signals.js";
import { Tracks, darkness, STEP } from "../src/effects/tracks.js";
import { LIMITS, Wheels, use } from "../src/effects/wheels.js";
import { tyresOf } from "../src/scene/tyres.js";

const UP = [0, 0, 1];
const names = (head, ends) => ends.map((end) => `${head}${end}`);
const xyz = (head) => names(head, ["x", "y", "z"]);
const tyre = (wheel) => ({
  contact: xyz(`${wheel}.contact_`), normal: xyz(`${wheel}.normal_`), axis: xyz(`${wheel}.axis_`), forces: names(`${wheel}.F`, ["x", "y", "z"]),
}); // prettier-ignore
const SCENE = {
  arrows: [{ name: "tyre FL", tyre: tyre("wheel_FL") }],
  shapes: [{ kind: "wheel", frame: "wheel FL", radius: 0.3, width: 0.2 }],
};

/** Numbers of one wheel that goes along x. */
function numbers(more = {}) {
  const base = {
    speed: 10, "wheel_FL.contact_x": 0, "wheel_FL.contact_y": 0, "wheel_FL.contact_z": 0, "wheel_FL.normal_x": 0, "wheel_FL.normal_y": 0,
    "wheel_FL.normal_z": 1, "wheel_FL.axis_x": 0, "wheel_FL.axis_y": 1, "wheel_FL.axis_z": 0, "wheel_FL.Fx": 0, "wheel_FL.Fy": 0,
    "wheel_FL.Fz": 1500, "wheel_FL.slip": 0, "wheel_FL.slip_angle": 0, "wheel_FL.omega": 10 / 0.3, ...more,
  }; // prettier-ignore
  return (name) => base[name];
}
const contact = (more = {}, options = {}) => new Wheels(SCENE, options).contacts(numbers(more))[0];

/** Goes along x and gives the tracks. @param {(station: number) => Data} slipAt @param {Data} [options] */
function drive(slipAt, { length = 10, most = 4096, surface } = {}) {
  const wheels = new Wheels(SCENE, { surface });
  const tracks = new Tracks(1, most);
  for (let k = 0; k * 0.05 <= length; k++) {
    const x = 0.05 * k;
    const lookup = numbers({ "wheel_FL.contact_x": x, ...slipAt(x) });
    tracks.update(wheels.contacts(lookup), x / 10, 1);
  }
  return tracks;
}
const marked = (tracks) => {
  const [ring] = tracks.rings;
  return Array.from({ length: ring.count }, (_, k) => tracks.row(ring, k)).map((row) => ({ x: row[0], dark: row[6] }));
};

test("the use of a tyre is 1 on the ellipse of its limits", () => {
  for (const angle of [0, 0.3, 1, 1.5]) {
    const [slip, lateral] = [LIMITS.slip * Math.cos(angle), LIMITS.lateral * Math.sin(angle)];
    assert.ok(Math.abs(use(slip, Math.atan(lateral)) - 1) < 1e-12);
    assert.ok(Math.abs(use(-slip, -Math.atan(lateral)) - 1) < 1e-12);
  }
});

test("marks are exactly where the slip is beyond the limit", () => {
  // Slip rises along the way: the limit is reached at x = 5.
  const seen = marked(drive((x) => ({ "wheel_FL.slip": (-LIMITS.slip * x) / 5 }), { length: 8 }));
  assert.ok(seen.length > 10);
  assert.ok(seen[0].x > 5 && seen[0].x <= 5.05 + 1e-9);
  assert.ok(seen.at(-1).x > 8 - STEP - 0.05);
  for (let k = 2; k < seen.length; k++) assert.ok(seen[k].dark >= seen[k - 1].dark);
  const turned = marked(drive((x) => ({ "wheel_FL.slip_angle": Math.atan((LIMITS.lateral * x) / 5) }), { length: 8 }));
  assert.ok(Math.abs(turned[0].x - seen[0].x) < 1e-9);
});

test("a sliding wheel leaves its track as wide as its tread, across its heading", () => {
  const tracks = drive(() => ({ "wheel_FL.slip": -0.9 }), { length: 2 });
  const row = tracks.row(tracks.rings[0], 1);
  assert.deepEqual([...row.slice(3, 6)], [0, 0.1, 0]);
});

test("nothing is left by steady slow driving, in the air, with a light load or on grass", () => {
  const steady = { "wheel_FL.slip": 0.01, "wheel_FL.slip_angle": 0.02 };
  const locked = { "wheel_FL.slip": -1 };
  assert.equal(drive(() => steady).count, 0);
  assert.equal(drive(() => ({ ...locked, "wheel_FL.Fz": 0 })).count, 0);
  assert.equal(drive(() => ({ ...locked, "wheel_FL.Fz": NaN })).count, 0);
  assert.equal(drive(() => ({ ...locked, speed: 0.1, "wheel_FL.omega": 0 })).count, 0);
  assert.equal(drive(() => locked, { surface: () => "grass" }).count, 0);
  assert.ok(drive(() => locked, { surface: () => "concrete" }).count > 50);
});

test("a mark ends where the wheel holds again, and begins again without a bridge", () => {
  const seen = marked(drive((x) => ({ "wheel_FL.slip": x < 3 || x > 6 ? -1 : 0 })));
  const begins = seen.filter(({ dark }) => dark === 0);
  assert.deepEqual(begins.map(({ x }) => Math.round(10 * x) / 10), [0, 6.1]);
});

test("marks are bounded: the oldest go", () => {
  const tracks = drive(() => ({ "wheel_FL.slip": -1 }), { length: 60, most: 100 });
  const seen = marked(tracks);
  assert.equal(seen.length, 100);
  assert.ok(seen[0].x > 60 - 101 * 0.15 && seen.at(-1).x > 59.8);
});

test("another epoch breaks a mark, and a rewind takes back what came later", () => {
  const tracks = drive(() => ({ "wheel_FL.slip": -1 }), { length: 10 });
  const before = tracks.count;
  const wheels = new Wheels(SCENE);
  const lookup = numbers({ "wheel_FL.contact_x": 4, "wheel_FL.slip": -1 });
  tracks.update(wheels.contacts(lookup), 0.4, 2);
  const seen = marked(tracks);
  assert.ok(seen.length < before);
  assert.equal(seen.at(-1).dark, 0);
  assert.ok(seen.slice(0, -1).every(({ x }) => x <= 4));
});

test("wheels throw up what they roll or slip on, and nothing when slow", () => {
  assert.equal(thrown(contact({}, { surface: () => "gravel" })).kind, "dust");
  assert.ok(thrown(contact({}, { surface: () => "gravel" })).rate > 0);
  assert.ok(thrown(contact({}, { surface: () => "wet" })).rate > 0);
  assert.equal(thrown(contact({}, { surface: () => "wet" })).kind, "spray");
  for (const surface of ["asphalt", "grass", "ice", "paint"]) assert.equal(thrown(contact({}, { surface: () => surface })).rate, 0, surface);
  const spinning = { "wheel_FL.slip": 0.8, "wheel_FL.omega": 100 };
  assert.ok(thrown(contact(spinning, { surface: () => "grass" })).rate > 10);
  const slow = { speed: 2, "wheel_FL.omega": 2 / 0.3 };
  for (const surface of ["asphalt", "grass", "gravel", "dirt", "wet"]) {
    assert.equal(thrown(contact(slow, { surface: () => surface })).rate, 0, surface);
  }
  assert.equal(thrown(contact({ "wheel_FL.Fz": 0, ...spinning }, { surface: () => "gravel" })).rate, 0);
});

test("particles are bounded, age by the time of the run and are gone after their life", () => {
  const wheels = new Wheels(SCENE, { surface: () => "gravel" });
  const cloud = new Cloud(1, 50);
  let time = 0;
  const go = (more, seconds) => {
    for (let k = 0; k < seconds * 50; k++) {
      time += 0.02;
      cloud.update(wheels.contacts(numbers({ "wheel_FL.contact_x": 10 * time, ...more })), UP, time, 1);
    }
  };
  go({ "wheel_FL.slip": 0.9 }, 4);
  assert.equal(cloud.count, 50);
  for (let k = 0; k < 100; k++) cloud.update(wheels.contacts(numbers()), UP, time, 1); // time stands
  assert.equal(cloud.count, 50);
  go({ "wheel_FL.Fz": 0 }, KINDS.dust.life + 0.1);
  assert.equal(cloud.count, 0);
});

test("dust rises from where the wheel was", () => {
  const wheels = new Wheels(SCENE, { surface: () => "gravel" });
  const cloud = new Cloud(1, 50);
  for (const time of [0, 0.1, 0.2]) cloud.update(wheels.contacts(numbers({ "wheel_FL.contact_x": 5 + 10 * time })), UP, time, 1);
  const row = cloud.rows.slice(0, 7);
  assert.ok(row[0] > 4.9 && row[0] < 7.2 && Math.abs(row[1]) < 0.15 && row[2] > 0);
  assert.ok(row[3] > 0 && row[3] < 10 && row[5] > 0);
});

test("a scene without tyres says so and goes on", () => {
  const wheels = new Wheels({});
  assert.match(wheels.problem, /no tyres/);
  assert.deepEqual(wheels.contacts(() => undefined), []);
});

const renamed = (wheel) => ({ ...tyre(`wheel_${wheel}`), forces: ["x", "y", "z"].map((axis) => `Car.F${axis}${wheel}`) });
const wheelShapes = ["RR", "FL"].map((wheel) => ({ kind: "wheel", frame: `wheel ${wheel}`, radius: 0.3, width: 0.2 }));

test("a tyre under other names has its own wheel, or none, and not the first", () => {
  const arrows = ["FL", "RR"].map((wheel) => ({ tyre: renamed(wheel) }));
  const seen = tyresOf({ arrows, shapes: wheelShapes }).map(({ slips, shape }) => [slips.slip, shape?.frame]);
  assert.deepEqual(seen, [["wheel_FL.slip", "wheel FL"], ["wheel_RR.slip", "wheel RR"]]); // prettier-ignore
  const strange = { ...tyre("Tyre[1]") };
  assert.equal(tyresOf({ arrows: [{ tyre: strange }], shapes: wheelShapes })[0].shape, undefined);
  assert.equal(tyresOf({ arrows: [{ tyre: strange }], shapes: wheelShapes.slice(1) })[0].shape, wheelShapes[1]);
});

test("slips that are not there are told", () => {
  const scene = { arrows: [{ tyre: renamed("FL") }], shapes: wheelShapes };
  assert.match(new Wheels(scene, { columns: ["Car.LongSlipFL"] }).problem, /no numbers wheel_FL.slip, wheel_FL.slip_angle, so these tyres/);
  assert.equal(new Wheels(scene, { columns: ["wheel_FL.slip", "wheel_FL.slip_angle"] }).problem, "");
  assert.equal(new Wheels(scene).problem, "");
});

test("slips under other names are read where the scene has their names", () => {
  const slips = { slip: "Car.LongSlipFL", slip_angle: "Car.SlipAngleFL", omega: "Car.WheelSpd_FL", speed: "Car.v" };
  const wheels = new Wheels({ arrows: [{ tyre: renamed("FL"), slips }], shapes: wheelShapes }, { columns: Object.values(slips) });
  assert.equal(wheels.problem, "");
  const values = { "Car.LongSlipFL": -0.5, "Car.SlipAngleFL": 0.02, "Car.WheelSpd_FL": 10, "Car.v": 12, "Car.FzFL": 2000 };
  /** @type {Record<string, number>} */
  const level = {};
  const { list } = wheels;
  list[0].tyre.normal.forEach((name, k) => (level[name] = [0, 0, 1][k]));
  list[0].tyre.axis.forEach((name, k) => (level[name] = [0, 1, 0][k]));
  const [found] = wheels.contacts((name) => values[name] ?? level[name] ?? 0);
  assert.deepEqual([found.touching, found.slip, found.speed], [true, -0.5, 12]);
  assert.ok(found.use > 1, "it leaves a mark");
});

test("the pitch of an engine is that of its firings, and it idles", () => {
  assert.ok(Math.abs(signals.enginePitch(100 * Math.PI) - 100) < 1e-9); // 3000 rev/min: 100 a second
  assert.equal(signals.enginePitch(0), signals.enginePitch(signals.IDLE));
  assert.equal(signals.motorPitch(0), 0);
  assert.ok(Math.abs(signals.motorPitch(-2 * Math.PI) - signals.WAVES) < 1e-9);
});

test("squeal rises with slip and load, and there is none below the limit", () => {
  let last = 0;
  for (let slip = 0; slip <= 1; slip += 0.01) {
    const level = signals.squealLevel(slip, 0.05, 1500, 20);
    assert.ok(level >= last && level <= 1);
    if (use(slip, 0.05) < 0.9) assert.equal(level, 0);
    last = level;
  }
  assert.ok(last > 0.4);
  assert.equal(signals.squealLevel(1, 0, 0, 20), 0);
  assert.ok(signals.squealLevel(0.3, 0, 3000, 20) > signals.squealLevel(0.3, 0, 1000, 20));
  assert.equal(signals.squealLevel(1, 0, 1500, 0.5), 0);
});

test("rolling noise and wind rise with speed, and flying wheels do not roll", () => {
  assert.equal(signals.rollingLevel(0, 1), 0);
  assert.equal(signals.windLevel(0), 0);
  assert.equal(signals.rollingLevel(30, 0), 0);
  assert.ok(signals.rollingLevel(30, 1) > signals.rollingLevel(10, 1));
  assert.ok(Math.abs(signals.windLevel(40) / signals.windLevel(20) - 4) < 1e-9);
});

test("a jump of the load thumps, a slow change does not", () => {
  assert.equal(signals.thumpLevel(1500, 1600, 0.016), 0);
  assert.equal(signals.thumpLevel(1500, 200, 0.016), 0);
  assert.ok(signals.thumpLevel(0, 6000, 0.016) > signals.thumpLevel(0, 2000, 0.016));
  assert.equal(signals.thumpLevel(0, 6000, 0), 0);
});

const COLUMNS = ["engine_speed", "speed", "used.throttle", "wheel_FL.slip", "wheel_FL.slip_angle", "wheel_FL.Fz", "wheel_FL.omega"];

test("while time stands, and before it runs, nothing is heard", () => {
  const mix = new CarMix(COLUMNS);
  assert.equal(mix.at(numbers(), 1), null);
  assert.notEqual(mix.at(numbers(), 1.02), null);
  assert.equal(mix.at(numbers(), 1.02), null);
  assert.equal(mix.at(numbers(), 0.5), null);
});

test("a car without an engine has none to hear, and an FMU without our names says so", () => {
  const car = new CarMix(["speed"]);
  car.at(numbers(), 0);
  const heard = car.at(numbers(), 0.02);
  assert.deepEqual([heard.engine, heard.motor, heard.squeal.level], [null, null, 0]);
  assert.ok(heard.wind.level > 0);
  assert.match(new CarMix(["angle"]).problem, /engine_speed.*speed/);
});

test("landing is heard once, steady driving is not", () => {
  const mix = new CarMix(COLUMNS);
  mix.at(numbers({ "wheel_FL.Fz": 0 }), 0);
  assert.equal(mix.at(numbers({ "wheel_FL.Fz": 5000 }), 0.016).thumps.length, 1);
  assert.equal(mix.at(numbers({ "wheel_FL.Fz": 5000 }), 0.032).thumps.length, 0);
});

test("a mark is darker with more slip and more load", () => {
  assert.equal(darkness(1, 5000), 0);
  assert.ok(darkness(1.5, 1500) < darkness(2, 1500));
  assert.ok(darkness(2, 500) < darkness(2, 1000));
  assert.ok(darkness(99, 1e6) < 1);
});
