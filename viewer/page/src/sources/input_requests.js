// Input requests of the sources of a page, sent and repeated by the link.

/** Inputs that keep their value when released: after a restart they are not requested again. */
const LASTING_INPUTS = ["selector"];
/** A value to a thousandth, so that noise of a device is no new request. @param {number} value */
const rounded = (value) => Math.round(1e3 * value) / 1e3 || 0;

/** The requests of the sources of a page. */
export class InputRequests {
  /** @param {{want: (source: string, values: Data) => void}} link sends new requests, and unchanged ones at an interval; see simulator/link.js */
  constructor(link) {
    this._link = link;
    this._sources = new Map();
  }

  /** Adds requests of a source. @param {string} source @param {[string, number, number?][]} wants input, value, largest change per second */
  want(source, wants) {
    const requests = this._sources.get(source) ?? {};
    this._sources.set(source, requests);
    for (const [name, value, rate = Infinity] of wants) requests[name] = [rounded(value), Number.isFinite(rate) ? rate : null];
    this._link.want(source, requests);
  }

  /** Repeats all requests; called for each picture. */
  again() {
    for (const [source, requests] of this._sources) this._link.want(source, requests);
  }

  /** Drops requests for lasting inputs after a restart of the car, which has its own values for them. */
  renew() {
    for (const requests of this._sources.values()) for (const name of LASTING_INPUTS) delete requests[name];
  }
}
