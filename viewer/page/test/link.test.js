// The connection of the page to the simulator: frames, messages, requests, reconnection.
import assert from "node:assert/strict";
import test from "node:test";
import { Link, readFrame } from "../src/simulator/link.js";

const HEAD = 96; // bytes: four integers, ten numbers
const MAGIC = 0x31463341; // "A3F1"

/** A frame as the simulator packs it: magic, epoch, flags, number of values; the numbers of `TEN`; the values. */
function frame(numbers, values, { magic = MAGIC, epoch = 7, flags = 1 } = {}) {
  const buffer = new ArrayBuffer(HEAD + 8 * values.length);
  const view = new DataView(buffer);
  [magic, epoch, flags, values.length].forEach((x, k) => view.setUint32(4 * k, x, true));
  numbers.forEach((x, k) => view.setFloat64(16 + 8 * k, x, true));
  values.forEach((x, k) => view.setFloat64(HEAD + 8 * k, x, true));
  return buffer;
}

/** Count, time, speed, wall, cost, worst, lateness, missed, deadline, saved. */
const TEN = [1000, 2.5, 0.5, 12, 1e-4, 2e-4, 3e-4, 4, 0.004, 30];

class Socket {
  /** @type {any[]} */
  static all = [];
  /** @type {any[]} */
  sent = [];
  readyState = 0;
  /** @type {(event: {reason: string}) => void} */
  onclose;
  constructor(url) {
    this.url = url;
    Socket.all.push(this);
  }
  open() {
    this.readyState = 1;
  }
  send(text) {
    this.sent.push(JSON.parse(text));
  }
  close() {
    this.lose("");
  }
  lose(reason) {
    this.readyState = 3;
    this.onclose({ reason });
  }
}

function linked(handlers = {}) {
  Socket.all = [];
  /** @type {Data} */
  const environment = { WebSocket: Socket, time: 0, timers: [] };
  environment.now = () => environment.time;
  environment.wait = (work, ms) => environment.timers.push([work, ms]);
  const link = new Link("ws://127.0.0.1:1/drive", handlers, environment);
  return { link, environment, socket: Socket.all[0] };
}

test("a frame is read number by number", () => {
  const found = readFrame(frame(TEN, [3, -1.5], { flags: 6 }));
  const { values, ...rest } = found;
  assert.deepEqual(rest, {
    epoch: 7, running: false, refused: true, behind: true, count: 1000, time: 2.5, speed: 0.5, wall: 12, cost: 1e-4,
    worst: 2e-4, lateness: 3e-4, missed: 4, deadline: 0.004, saved: 30,
  }); // prettier-ignore
  assert.deepEqual([...values], [3, -1.5]);
});

test("what is not a frame is refused", () => {
  assert.throws(() => readFrame(frame(TEN, [], { magic: 1 })), /not a frame/);
  assert.throws(() => readFrame(new ArrayBuffer(10)), /not a frame/);
  assert.throws(() => readFrame(frame(TEN, [1, 2]).slice(0, 100)), /2 numbers has 100 bytes/);
});

test("every frame is acknowledged and handed on", () => {
  const received = [];
  const { socket } = linked({ frame: (found) => received.push(found.count) });
  socket.open();
  socket.onmessage({ data: frame(TEN, []) });
  assert.deepEqual(received, [1000]);
  assert.deepEqual(socket.sent, [{ type: "seen", count: 1000 }]);
  assert.equal(socket.binaryType, "arraybuffer");
});

test("messages go to their handlers, and one that nobody handles is ignored", () => {
  const received = [];
  const { socket } = linked({ hello: (m) => received.push(m), event: (m) => received.push(m) });
  for (const m of [{ type: "hello", version: 1 }, { type: "devices", devices: [] }, { type: "refused", text: "No." }]) {
    socket.onmessage({ data: JSON.stringify(m) });
  }
  assert.equal(received[0].version, 1);
  assert.equal(received[1].kind, "refused message");
  assert.equal(received[1].text, "No.");
  assert.equal(received.length, 2);
});

test("a request is sent when it changes, and again when 200 ms have passed", () => {
  const { link, environment, socket } = linked();
  link.want("keys", { throttle: [1, 2.5] }); // nobody hears it yet
  socket.open();
  for (let k = 0; k < 10; k++) link.want("keys", { throttle: [1, 2.5] });
  assert.equal(socket.sent.length, 1);
  assert.deepEqual(socket.sent[0], { type: "want", source: "keys", values: { throttle: [1, 2.5] } });
  link.want("keys", { throttle: [0, 5] });
  link.want("gamepad", { steering: [0.25, null] });
  assert.equal(socket.sent.length, 3);
  environment.time = 250;
  link.want("keys", { throttle: [0, 5] });
  assert.equal(socket.sent.length, 4);
  link.command("rewind", 5);
  assert.deepEqual(socket.sent[4], { type: "command", name: "rewind", value: 5 });
});

test("a lost connection is reported and tried again with increasing delays", () => {
  const words = [];
  const { link, environment, socket } = linked({ closed: (text, again) => words.push({ text, again }) });
  socket.open();
  link.want("keys", { throttle: [1, 2.5] });
  socket.lose("Too many pages are connected.");
  assert.equal(link.connected, false);
  assert.equal(link.send({ type: "report" }), false);
  assert.equal(words[0].text, "The simulator is not there: Too many pages are connected. Trying again in 0.3 s.");
  environment.timers[0][0]();
  assert.equal(Socket.all.length, 2);
  Socket.all[1].lose("");
  assert.equal(words[1].text, "The simulator is not there: Too many pages are connected. Trying again in 0.5 s.");
  for (let k = 1; k < 8; k++) {
    environment.timers[k][0]();
    Socket.all[k + 1].lose("");
  }
  assert.equal(words.at(-1).again, 4000);
  environment.timers[8][0]();
  const last = Socket.all.at(-1);
  last.open();
  last.onmessage({ data: '{"type":"hello"}' });
  link.want("keys", { throttle: [1, 2.5] }); // sent again
  assert.equal(last.sent.length, 1);
  last.lose("");
  assert.equal(words.at(-1).again, 250);
});

test("a link that is closed stays closed", () => {
  const words = [];
  const { link, environment, socket } = linked({ closed: (text, again) => words.push({ text, again }) });
  socket.open();
  link.close();
  assert.deepEqual([words, environment.timers], [[], []]);
  const other = linked();
  other.socket.lose("");
  other.link.close();
  other.environment.timers[0][0]();
  assert.equal(Socket.all.length, 1);
});

test("what is not understood is reported, and the connection tried again", () => {
  for (const { data, why } of [{ data: "{", why: /JSON/ }, { data: frame(TEN, [], { magic: 1 }), why: /This is not a frame of a simulator/ }]) {
    const words = [];
    const { environment, socket } = linked({ closed: (text) => words.push(text), event: () => assert.fail() });
    socket.open();
    socket.onmessage({ data });
    assert.equal(words.length, 1);
    assert.match(words[0], /^The simulator is not there: what it says is not understood: .*\. Trying again in 0\.3 s\.$/);
    assert.match(words[0], why);
    assert.equal(environment.timers.length, 1);
  }
});
