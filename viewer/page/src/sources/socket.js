// A car that another program drives, as a source of a page (see `Source` in shell/shell.js): its frames arrive by a socket.
import { speedActions, unitsOf } from "./source_actions.js";
import { Blend } from "./blend.js";
import { Frames } from "./frames.js";
import { InputRequests } from "./input_requests.js";

/** Largest count of numbers kept for diagrams, and of points of a curve. */
const [MAX_KEPT_NUMBERS, MAX_POINTS] = [1e7, 1000];

/** The car of a link, as a source. */
export class Socket {
  grows = true;
  speeds = [0.1, 0.25, 0.5, 1];
  frames = new Frames();
  /** Frames since the last start, for diagrams: time and values. @type {{time: number, values: ArrayLike<number>}[]} */
  _past = [];
  _shown = null;

  /** @param {Data} hello first message of the program @param {import("../simulator/link.js").Link} link */
  constructor({ scene, columns, description, constants = {}, world = {} }, link) {
    const variables = description?.variables ?? [];
    this.index = new Map(columns.map((name, k) => [name, k]));
    const units = new Map(variables.map(({ name, unit }) => [name, unit]));
    this.columns = unitsOf(columns, (name) => units.get(name));
    this._blend = new Blend(scene, variables);
    this._fixed = new Map([...variables.map((v) => [v.name, v.start]), ...Object.entries(constants)]);
    this.wants = new InputRequests(link);
    const command = (name, value) => link.command(name, value);
    const back = (seconds) => command("rewind", seconds);
    this.acts = {
      ...speedActions(this, { speed: (factor) => command("speed", factor), back }),
      toggle: () => command(this.running ? "pause" : "run"),
      step: () => command("step", 1),
      seek: (time, done) => done && back(this.range[1] - time), // sent when dragging has ended
      upright: () => command("upright"),
      reset: () => command("reset"),
      ...((world.places ?? []).length ? { place: (name) => link.send({ type: "place", name }) } : {}),
    };
  }

  get running() {
    return this.frames.newest?.running ?? false;
  }

  get speed() {
    return this.frames.newest?.speed ?? 1;
  }

  /** Time of the picture, s. */
  get time() {
    return this._shown?.time ?? 0;
  }

  /** Times to which the program can go back, s. @returns {[number, number]} */
  get range() {
    const { time = 0, saved = 0 } = this.frames.newest ?? {};
    return [time - saved, time];
  }

  /** Adds a received frame. @param {any} frame Result of `readFrame` @param {number} now clock of the page, s @returns {boolean} whether it begins an epoch */
  add(frame, now) {
    const restarted = this.frames.add(frame, now);
    while (this._past.length && this._past.at(-1).time >= frame.time) this._past.pop();
    this._past.push(frame);
    if (this._past.length * this.index.size > MAX_KEPT_NUMBERS) this._past.splice(0, this._past.length >> 2);
    return restarted;
  }

  /** The instant of the picture, see `Frames.at`; null before the first frame. @param {number} now clock of the page, s */
  at(now) {
    this._shown = this.frames.at(now);
    return this._shown;
  }

  /** Lookup of the numbers of the car at the instant of the picture, NaN before the first frame. @returns {import("../shell/shell.js").Lookup[]} */
  sample() {
    if (!this._shown) return [() => NaN];
    const { before, after, share } = this._shown;
    const numbers = (/** @type {Data} */ { values }) => (name) => values[this.index.get(name)];
    const row = this._blend.lookup(numbers(before), numbers(after), share);
    return [(name) => (this.index.has(name) ? row(name) : Number(this._fixed.get(name) ?? NaN))];
  }

  /** The value of a constant, or the start value of a parameter. @param {string} name */
  fixed(name) {
    return this._fixed.get(name);
  }

  /** Passes on requests for inputs. @param {string} source @param {[string, number, number?][]} wants input, value, largest change per second */
  want(source, wants) {
    this.wants.want(source, wants);
  }

  /** Some columns over the last seconds. @param {string[]} names @param {number} span s */
  plotted(names, span) {
    const first = (this._past.at(-1)?.time ?? 0) - span;
    const recent = this._past.filter(({ time }) => time >= first);
    const stride = Math.max(1, Math.ceil(recent.length / MAX_POINTS));
    const thinned = recent.filter((_, k) => k % stride === 0 || k === recent.length - 1);
    const column = (name) => thinned.map(({ values }) => values[this.index.get(name)]);
    const columns = Object.fromEntries(names.map((name) => [name, { unit: this.columns.get(name), data: column(name) }]));
    return [{ name: "", t: thinned.map(({ time }) => time), columns }];
  }
}
