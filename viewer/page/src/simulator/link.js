// The page's side of the socket to the simulator: frames in, requests and commands out.

const MAGIC = 0x31463341;
const HEADER = 96;
const RUNNING = 1, REFUSED = 2, BEHIND = 4; // prettier-ignore
const NUMBERS = ["count", "time", "speed", "wall", "cost", "worst", "lateness", "missed", "deadline", "saved"];
/** A request that has not changed is said again after so long, so that the simulator knows that the page is alive. */
const AGAIN = 200;
/** Milliseconds before the first and the later tries to connect again. */
const FIRST_WAIT = 250;
const LONGEST_WAIT = 4000;

/**
 * Read a frame.
 * @param {ArrayBuffer} buffer
 * @returns {Data} Numbers of the header, three flags, and `values`, a Float64Array in the order of the columns.
 */
export function readFrame(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER || view.getUint32(0, true) !== MAGIC) throw new Error("This is not a frame of a simulator.");
  const flags = view.getUint32(8, true);
  const size = view.getUint32(12, true);
  if (buffer.byteLength !== HEADER + 8 * size) {
    throw new Error(`A frame of ${size} numbers has ${buffer.byteLength} bytes.`);
  }
  const frame = {
    epoch: view.getUint32(4, true),
    running: (flags & RUNNING) !== 0,
    refused: (flags & REFUSED) !== 0,
    behind: (flags & BEHIND) !== 0,
  };
  NUMBERS.forEach((name, k) => (frame[name] = view.getFloat64(16 + 8 * k, true)));
  frame.values = new Float64Array(buffer, HEADER, size); // every computer with a browser is little endian
  return frame;
}

/** A frame or a message that has come, or what is wrong with it. @param {string | ArrayBuffer} data @returns {Data} */
function heard(data) {
  try {
    return typeof data === "string" ? { message: JSON.parse(data) ?? {} } : { frame: readFrame(data) };
  } catch (error) {
    return { wrong: error.message };
  }
}

/** A connection that comes back by itself. */
export class Link {
  /**
   * @param {string|URL} url - Of the socket, with the token where there is one.
   * @param {Data} handlers - `hello`, `frame`, `event`, `report`, `devices`, `refused` get what the simulator says;
   *   `closed` gets a sentence and in how many ms it is tried again.
   * @param {{WebSocket?: typeof WebSocket, now?: () => number, wait?: (work: () => void, ms: number) => void}} [means] - Replaced in tests.
   */
  constructor(url, handlers, means = {}) {
    this._url = url;
    this._handlers = handlers;
    this._Socket = means.WebSocket ?? globalThis.WebSocket;
    this._now = means.now ?? (() => performance.now());
    this._wait = means.wait ?? ((work, ms) => setTimeout(work, ms));
    this._said = new Map(); // source -> {text, at}
    this._tries = 0;
    this._closed = false;
    this._reason = "";
    this._open();
  }

  /** Whether the simulator hears the page. */
  get connected() {
    return this._socket.readyState === 1;
  }

  /**
   * Say what a source wants; may be called in every picture: what has not changed is said again now and then only.
   * @param {"keys"|"gamepad"|"touch"} source
   * @param {Object<string, [number, number|null]>} values - Input to value and largest change per second, null: at once.
   */
  want(source, values) {
    const text = JSON.stringify({ type: "want", source, values });
    const before = this._said.get(source);
    const now = this._now();
    if (before && before.text === text && now - before.at < AGAIN) return;
    if (this._send(text)) this._said.set(source, { text, at: now });
  }

  /**
   * A command to the car.
   * @param {string} name
   * @param {number} [value]
   */
  command(name, value = 0) {
    this.send({ type: "command", name, value });
  }

  /**
   * Say anything.
   * @param {Data} message
   * @returns {boolean} Whether it could be said.
   */
  send(message) {
    return this._send(JSON.stringify(message));
  }

  /** Close for good. */
  close() {
    this._closed = true;
    this._socket.close();
  }

  _open() {
    const socket = new this._Socket(this._url);
    this._socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onmessage = (message) => this._take(message.data);
    socket.onclose = (event) => this._lost(event?.reason ?? "");
  }

  _send(text) {
    if (!this.connected) return false;
    this._socket.send(text);
    return true;
  }

  _take(data) {
    const { frame, message, wrong } = heard(data);
    if (wrong) {
      this._reason = `what it says is not understood: ${wrong}`;
      this._socket.close();
      return;
    }
    if (frame) {
      this.send({ type: "seen", count: frame.count });
      this._handlers.frame?.(frame);
      return;
    }
    if (message.type === "hello") [this._tries, this._reason] = [0, ""];
    if (message.type === "refused" && !this._handlers.refused) {
      this._handlers.event?.({ type: "event", kind: "refused message", time: NaN, text: message.text });
    } else {
      this._handlers[message.type]?.(message);
    }
  }

  _lost(reason) {
    this._said.clear();
    if (this._closed) return;
    const wait = Math.min(FIRST_WAIT * 2 ** this._tries, LONGEST_WAIT);
    this._tries += 1;
    this._reason = reason || this._reason; // what the server said at its end stands until there is one again
    const why = this._reason ? `: ${this._reason.replace(/\.$/, "")}` : "";
    const text = `The simulator is not there${why}. Trying again in ${(wait / 1000).toFixed(1)} s.`;
    this._handlers.closed?.(text, wait);
    this._wait(() => this._closed || this._open(), wait);
  }
}
