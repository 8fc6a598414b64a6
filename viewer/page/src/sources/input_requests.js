// Input requests of a source as messages, resent at the rate of the socket.

/** Inputs that stay as they were put: after a new start they are not asked for again. */
const STAY = ["selector"];
const rounded = (value) => Math.round(1e3 * value) / 1e3 || 0;

/** The requests of the sources of a page. */
export class InputRequests {
  /** @param {{want: (source: string, values: Data) => void}} link - Passes on what is new or old enough; see simulator/link.js. */
  constructor(link) {
    this._link = link;
    this._sources = new Map();
  }

  /** @param {string} source @param {[string, number, number?][]} wants - Input, value, largest change per second. */
  want(source, wants) {
    const known = this._sources.get(source) ?? {};
    this._sources.set(source, known);
    for (const [name, value, rate = Infinity] of wants) known[name] = [rounded(value), Number.isFinite(rate) ? rate : null];
    this._link.want(source, known);
  }

  /** Say again what holds; called for each picture. */
  again() {
    for (const [source, known] of this._sources) this._link.want(source, known);
  }

  /** The car was put somewhere else: hands hold what they hold, but what stays is as the car has it. */
  renew() {
    for (const known of this._sources.values()) for (const name of STAY) delete known[name];
  }
}
