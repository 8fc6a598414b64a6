// The page's side of the socket to the simulator: frames in, requests and commands out.

const MAGIC = 0x31463341;
const HEADER_SIZE = 96;
const RUNNING = 1, REFUSED = 2, BEHIND = 4; // prettier-ignore
const HEADER_NUMBERS = ["count", "time", "speed", "wall", "cost", "worst", "lateness", "missed", "deadline", "saved"];
/** Interval at which an unchanged request is sent again, so that the simulator knows that the page is alive, ms. */
const REPEAT_INTERVAL = 200;
/** Waiting time before the first attempt to reconnect, doubled with each further one up to the longest, ms. */
const MIN_WAIT = 250;
const MAX_WAIT = 4000;

/**
 * Reads a frame.
 * @param {ArrayBuffer} buffer
 * @returns {Data} epoch, three flags, the other numbers of the header by name, and `values`, a Float64Array in the order of the columns
 */
export function readFrame(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER_SIZE || view.getUint32(0, true) !== MAGIC) throw new Error("This is not a frame of a simulator.");
  const flags = view.getUint32(8, true);
  const size = view.getUint32(12, true);
  if (buffer.byteLength !== HEADER_SIZE + 8 * size) {
    throw new Error(`A frame of ${size} numbers has ${buffer.byteLength} bytes.`);
  }
  const frame = {
    epoch: view.getUint32(4, true),
    running: (flags & RUNNING) !== 0,
    refused: (flags & REFUSED) !== 0,
    behind: (flags & BEHIND) !== 0,
  };
  HEADER_NUMBERS.forEach((name, k) => (frame[name] = view.getFloat64(16 + 8 * k, true)));
  frame.values = new Float64Array(buffer, HEADER_SIZE, size); // every computer with a browser is little endian
  return frame;
}

/** Decodes received data: `frame` or `message`, or `wrong`, the text of an error. @param {string | ArrayBuffer} data @returns {Data} */
function decoded(data) {
  try {
    return typeof data === "string" ? { message: JSON.parse(data) ?? {} } : { frame: readFrame(data) };
  } catch (error) {
    return { wrong: error.message };
  }
}

/** A connection that is opened again after it was lost. */
export class Link {
  /**
   * @param {string|URL} url of the socket, with the token if there is one
   * @param {Data} handlers `hello`, `frame`, `event`, `report`, `devices`, `refused` get the frame or message of that type;
   *   `closed` gets a sentence and the time to the next attempt, ms.
   * @param {{WebSocket?: typeof WebSocket, now?: () => number, wait?: (work: () => void, ms: number) => void}} [environment] replaced in tests
   */
  constructor(url, handlers, environment = {}) {
    this._url = url;
    this._handlers = handlers;
    this._Socket = environment.WebSocket ?? globalThis.WebSocket;
    this._now = environment.now ?? (() => performance.now());
    this._wait = environment.wait ?? ((work, ms) => setTimeout(work, ms));
    this._sent = new Map(); // source -> {text, at}
    this._tries = 0;
    this._closed = false;
    this._reason = "";
    this._open();
  }

  /** Whether the socket is open. */
  get connected() {
    return this._socket.readyState === 1;
  }

  /**
   * Sends the requests of a source. May be called in every picture: unchanged ones are sent again at an interval only.
   * @param {"keys"|"gamepad"|"touch"} source
   * @param {Object<string, [number, number|null]>} values by input: value and largest change per second, null for a jump
   */
  want(source, values) {
    const text = JSON.stringify({ type: "want", source, values });
    const previous = this._sent.get(source);
    const now = this._now();
    if (previous && previous.text === text && now - previous.at < REPEAT_INTERVAL) return;
    if (this._send(text)) this._sent.set(source, { text, at: now });
  }

  /** Sends a command to the car. @param {string} name @param {number} [value] */
  command(name, value = 0) {
    this.send({ type: "command", name, value });
  }

  /** Sends a message. @param {Data} message @returns {boolean} false while the socket is not open */
  send(message) {
    return this._send(JSON.stringify(message));
  }

  /** Closes for good. */
  close() {
    this._closed = true;
    this._socket.close();
  }

  _open() {
    const socket = new this._Socket(this._url);
    this._socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onmessage = (message) => this._receive(message.data);
    socket.onclose = (event) => this._lost(event?.reason ?? "");
  }

  _send(text) {
    if (!this.connected) return false;
    this._socket.send(text);
    return true;
  }

  _receive(data) {
    const { frame, message, wrong } = decoded(data);
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
    this._sent.clear();
    if (this._closed) return;
    const wait = Math.min(MIN_WAIT * 2 ** this._tries, MAX_WAIT);
    this._tries += 1;
    this._reason = reason || this._reason; // the server's last reason is shown until it is back
    const explanation = this._reason ? `: ${this._reason.replace(/\.$/, "")}` : "";
    const text = `The simulator is not there${explanation}. Trying again in ${(wait / 1000).toFixed(1)} s.`;
    this._handlers.closed?.(text, wait);
    this._wait(() => this._closed || this._open(), wait);
  }
}
