// The instruments of the driver: speed, gear, revolutions, pedals, steering.
import { el, whole, write } from "../common/dom.js";
import { FILLS, Gauge } from "./gauges.js";

/** Outputs of the speed of the engine or motor; the first existing one is shown. */
const SPEEDS = ["engine_speed", "motor_speed"];
const RPM = 30 / Math.PI;
/** Initial end of the bar of the engine speed, rpm, and share from which it is red. */
const [INITIAL_RPM, RED_SHARE] = [6000, 0.92];
const BARS = { brake: FILLS.red, throttle: FILLS.green, hand_brake: FILLS.amber };

/** Instruments of a car, as far as the FMU has outputs for them. */
export class Cluster {
  /** @param {Set<string>} names columns of the FMU */
  constructor(names) {
    const used = (name) => [`used.${name}`, name].find((column) => names.has(column));
    this._names = names;
    this._speed = el("b", { data: "speed" });
    this._gear = el("span.a3-gear", { data: "gear" });
    this._turns = SPEEDS.find((name) => names.has(name));
    this._revolutions = new Gauge({ data: "revolutions" });
    this._most = INITIAL_RPM;
    this._pedals = Object.entries(BARS)
      .map(([name, colour]) => ({ column: used(name), gauge: new Gauge({ data: `pedal ${name}`, label: name.replace("_", " "), way: "up", colour }) }))
      .filter(({ column }) => column);
    this._wheel = names.has("steering_wheel_angle") ? "steering_wheel_angle" : used("steering");
    this._steering = new Gauge({ data: "steering bar", label: "steering", way: "middle" });
    this._selector = used("selector");
    const figures = el("div.a3-figures", {}, this._speed, el("small", {}, "km/h"), this._gear);
    const middle = el("div.a3-middle", {}, figures);
    if (this._turns) middle.append(this._revolutions.element);
    if (used("steering")) middle.append(this._steering.element);
    this._used = used("steering");
    this.element = el("div.a3-cluster", { data: "cluster" }, middle, ...this._pedals.map(({ gauge }) => gauge.element));
  }

  /** @param {(name: string) => number} lookup */
  show(lookup) {
    const speed = lookup("speed");
    write(this._speed, whole(3.6 * Math.abs(speed)));
    write(this._gear, gearWords(lookup, { selector: this._selector, gear: this._names.has("gear") ? "gear" : undefined }));
    if (this._turns) {
      const turns = RPM * Math.abs(lookup(this._turns));
      if (turns > this._most) this._most = 1000 * Math.ceil(turns / 1000);
      this._revolutions.show(turns / this._most, turns > RED_SHARE * this._most ? FILLS.red : undefined);
      this._revolutions.words(`${whole(turns)} rpm`);
    }
    if (this._used) {
      const value = lookup(this._used);
      this._steering.show(value);
      const angle = lookup(this._wheel);
      this._steering.words(this._wheel === this._used ? "" : `${whole((180 / Math.PI) * angle)}°`);
    }
    for (const { column, gauge } of this._pedals) gauge.show(lookup(column));
  }
}

/**
 * Text of the gear: R, N, or its number.
 * @param {(name: string) => number} lookup
 * @param {{selector?: string, gear?: string}} columns those that the FMU has
 */
export function gearWords(lookup, { selector, gear }) {
  const position = selector ? Math.round(lookup(selector)) : 1;
  if (position < 1) return position < 0 ? "R" : "N";
  return gear ? `gear ${whole(lookup(gear))}` : ""; // a recording has no types and is interpolated
}
