// Gamepads and wheels by the Gamepad API: found when they are plugged in, axes assigned, a dead zone.

/** How a device drives a car: an axis or button for each input. */
export const STANDARD = { steering: "axis 0 inverted", throttle: "button 7", brake: "button 6", hand_brake: "button 0" };
/** Wheels and other devices that the browser does not know. */
export const OTHER = { steering: "axis 0 inverted", throttle: "none", brake: "none", hand_brake: "none" };

/** Change of an axis or button from which on the device has the word. */
const TOUCHED = 0.02;

/**
 * An axis with a dead zone in its middle; beyond it the value goes on from 0.
 * @param {number} value - From -1 to 1.
 * @param {number} zone - Half-width.
 */
export function withDeadZone(value, zone) {
  const beyond = Math.max(0, Math.abs(value) - zone) / (1 - zone);
  return Math.sign(value) * Math.min(1, beyond);
}

/**
 * What an assignment reads from a device.
 * @param {{axes: number[], buttons: {value: number}[]}} pad
 * @param {string} source - "axis 2", "axis 2 inverted", "button 7" or "none".
 * @param {boolean} pedal - From 0 to 1: an axis is then read from its one end to the other.
 * @param {number} zone
 */
export function readSource(pad, source, pedal, zone) {
  const [kind, number, inverted] = source.split(" ");
  if (kind === "button") return pad.buttons[Number(number)]?.value ?? 0;
  if (kind !== "axis") return 0;
  const value = (inverted ? -1 : 1) * (pad.axes[Number(number)] ?? 0);
  if (!pedal) return withDeadZone(value, zone);
  if (!pad.axes[Number(number)]) return 0; // browsers give 0 until an axis was moved
  return Math.min(1, Math.max(0, ((value + 1) / 2 - zone) / (1 - zone)));
}

/** All that a device can be assigned to. */
export function sourcesOf(pad) {
  const axes = Array.from(pad.axes, (_, k) => [`axis ${k}`, `axis ${k} inverted`]).flat();
  return ["none", ...axes, ...Array.from(pad.buttons, (_, k) => `button ${k}`)];
}

/** The device that drives. */
export class Gamepad {
  /** @param {() => (Data|null)[]} list - `navigator.getGamepads`, or one for a test. */
  constructor(list) {
    this._list = list;
    this.zone = 0.08;
    this.pad = null;
    this.assigned = {};
    this._id = null;
    this._before = null;
  }

  /**
   * Look at the devices.
   * @returns {{changed: boolean, touched: boolean}} Whether another device is there now, and whether it was moved.
   */
  poll() {
    const pads = [...(this._list() ?? [])].filter((pad) => pad && pad.connected !== false);
    this.pad = pads.find((pad) => pad.id === this._id) ?? pads[0] ?? null;
    const changed = (this.pad?.id ?? null) !== this._id;
    if (changed) {
      this._id = this.pad?.id ?? null;
      this.assigned = { ...(this.pad?.mapping === "standard" ? STANDARD : OTHER), ...stored(this._id) };
      this._before = null;
    }
    if (!this.pad) return { changed, touched: false };
    const now = [...this.pad.axes, ...this.pad.buttons.map((b) => b.value)];
    const touched = this._before !== null && now.some((v, k) => Math.abs(v - this._before[k]) > TOUCHED);
    if (touched || this._before === null) this._before = now;
    return { changed, touched };
  }

  /** Assign an axis or button to an input; kept for this device. */
  assign(name, source) {
    this.assigned[name] = source;
    try {
      localStorage.setItem(`ali3 gamepad ${this._id}`, JSON.stringify(this.assigned));
    } catch {
      // a page from a disk may have no storage: then it holds as long as the page
    }
  }

  /** What is wanted now: input, value; at once. */
  wants() {
    if (!this.pad) return [];
    return Object.entries(this.assigned)
      .filter(([, source]) => source !== "none")
      .map(([name, source]) => [name, readSource(this.pad, source, name !== "steering", this.zone)]);
  }
}

function stored(id) {
  try {
    return JSON.parse(localStorage.getItem(`ali3 gamepad ${id}`) ?? "{}");
  } catch {
    return {};
  }
}
