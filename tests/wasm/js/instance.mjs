// node instance.mjs FMU_JS < JOB: what the page's instance does with refusals, states, types and files.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { loadFmu, FmuError } = await import(pathToFileURL(process.argv[2]).href);
const { wasm, resources, description } = JSON.parse(readFileSync(0, "utf8"));
const bytesOf = (text) => new Uint8Array(Buffer.from(text, "base64"));
const files = Object.fromEntries(Object.entries(resources).map(([path, text]) => [path, bytesOf(text)]));
const load = (more = {}) => loadFmu({ wasm: bytesOf(wasm), description, resources: files, ...more });
const told = {};

/** What a call is refused with. */
const refused = (work) => {
  try {
    work();
  } catch (error) {
    return [error instanceof FmuError, error.status ?? null, error.message];
  }
  return null;
};
const refusedLater = async (promise) => promise.then(() => null, (error) => error.message);
const outputs = description.variables.filter((v) => v.causality === "output").map((v) => v.name);

told.noDescription = await refusedLater(load({ description: {} }));
told.text = await refusedLater(load({ description: "<fmiModelDescription/>" }));
told.noWasm = await refusedLater(load({ wasm: new Uint8Array([1, 2, 3, 4, 5, 6, 7, 8]) }));
told.empty = await refusedLater(load({ wasm: new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]) }));
told.noResources = refused(() => 0) ?? (await load({ resources: {} }).then((fmu) => refused(() => fmu.instantiate())));
told.otherGuid = await load({ description: { ...description, guid: "{0}" } }).then((fmu) =>
  refused(() => fmu.instantiate()),
);

const fmu = await load();
const car = fmu.instantiate({ logging: true });
told.loaded = car.messages.map((m) => [m.status, m.category, m.text]);
told.early = refused(() => car.step(0.002));
told.unknown = refused(() => car.set("wings", 1));
told.nan = refused(() => car.set("road.friction", NaN));
told.far = refused(() => car.set("road.friction", -3));
told.half = refused(() => car.set("fidelity", 0.5));
told.wrongType = refused(() => car.setReal("fidelity", 1));
told.output = refused(() => car.set("chassis.x", 1));
told.start = refused(() => car.set("initial.z", -300)) ?? refused(() => car.initialise());
car.set("initial.z", 0);
told.otherTime = refused(() => car.initialise({ startTime: 3 }));
told.noRoad = refused(() => car.set("road.file", "nowhere.road"));
fmu.addFile("roads/dropped.csv", new TextEncoder().encode("y/x;0;1\n0;0;0\n1;0;0\n"));
fmu.addFile("roads/dropped.csv", new TextEncoder().encode(";-50;50\n-50;0,1;0,1\n500;0,1;0,1\n"));
car.set("road.file", "dropped.csv");
car.set({ "initial.speed": 10, selector: 1 });
car.initialise();
told.road = car.getString("road.file");
told.height = car.get(["chassis.z"])[0];

const read = car.reader([...outputs].reverse());
const write = car.writer(["steering", "selector", "throttle"]);
told.wholeInput = refused(() => write([0.1, 0.5, 0.2]));
told.tooFew = refused(() => write([0.1]));
told.textRead = refused(() => car.get(["road.file"]));
write([0.1, 1, 0.3]);
for (let k = 0; k < 50; k++) car.step(0.002);
told.time = car.time;
const before = car.getState();
const bytes = car.serialise(before);
const there = read().slice();
told.reversed = there.every((v, k) => Object.is(v, car.get([outputs[outputs.length - 1 - k]])[0]));
told.badStep = refused(() => car.step(-1));
told.badTime = car.time;
told.states = [];
for (const again of [0, 1]) {
  for (let k = 0; k < 30; k++) car.step(0.002);
  const end = read().slice();
  car.setState(again === 0 ? before : car.deserialise(bytes));
  told.states.push([car.time, read().every((v, k) => Object.is(v, there[k])), end.some((v, k) => v !== there[k])]);
}
told.damaged = refused(() => car.deserialise(bytes.map((b, k) => (k === 2000 ? b ^ 1 : b))));

// states that are used again and given back take no more memory
const kept = [0, 1, 2, 3].map(() => car.getState());
const memory = fmu.exports.memory.buffer.byteLength;
for (let k = 0; k < 3000; k++) car.getState(kept[k % 4]);
for (let k = 0; k < 500; k++) car.get(["chassis.x", "gear"]);
for (let k = 0; k < 200; k++) {
  const other = fmu.instantiate();
  other.reader(outputs);
  other.writer(["steering"])([0.1]);
  other.deserialise(bytes);
  other.getState().free();
  other.getState();
  other.free();
}
told.grown = fmu.exports.memory.buffer.byteLength - memory;

// another instance in the same memory knows nothing of the first
const other = fmu.instantiate();
other.set("initial.speed", 10);
other.initialise({ startTime: 1, stopTime: 1.1 });
told.otherTimeNow = [other.time, car.time];
for (let k = 0; k < 50; k++) other.step(0.002);
told.beyond = refused(() => other.step(0.002));
other.terminate();
told.ended = refused(() => other.step(0.002));
other.reset();
other.initialise();
other.step(0.002);
told.again = other.time;
other.free();
told.freed = refused(() => other.step(0.002));
car.step(0.002);
told.messages = car.messages.filter((m) => m.status !== "ok").length > 5;

// after a trap nothing is called any more
told.trap = refused(() => fmu.call(() => fmu.exports.fmi2GetReal(0xfffffff0, 0, 1, 0)));
told.after = refused(() => car.step(0.002));
process.stdout.write(JSON.stringify(told));
