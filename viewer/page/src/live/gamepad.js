// Gamepads and steering wheels by the Gamepad API: detection, assignment of axes, dead zone.

/** Axis or button of each input of a car, for gamepads with the standard layout. */
export const STANDARD = { steering: "axis 0 inverted", throttle: "button 7", brake: "button 6", hand_brake: "button 0" };
/** The same for steering wheels and other devices with unknown layout. */
export const OTHER = { steering: "axis 0 inverted", throttle: "none", brake: "none", hand_brake: "none" };

/** Change of an axis or button at which the device takes control. */
const TAKEOVER_CHANGE = 0.02;

/**
 * Value of an axis with a dead zone in its middle, continuous at its ends.
 * @param {number} value from -1 to 1
 * @param {number} zone half-width
 */
export function withDeadZone(value, zone) {
  const beyond = Math.max(0, Math.abs(value) - zone) / (1 - zone);
  return Math.sign(value) * Math.min(1, beyond);
}

/**
 * Value of an assigned axis or button of a device.
 * @param {{axes: number[], buttons: {value: number}[]}} pad
 * @param {string} source "axis 2", "axis 2 inverted", "button 7" or "none"
 * @param {boolean} pedal whether the range is 0 to 1 over the whole axis
 * @param {number} zone
 */
export function readSource(pad, source, pedal, zone) {
  const [kind, number, inverted] = source.split(" ");
  if (kind === "button") return pad.buttons[Number(number)]?.value ?? 0;
  if (kind !== "axis") return 0;
  const value = (inverted ? -1 : 1) * (pad.axes[Number(number)] ?? 0);
  if (!pedal) return withDeadZone(value, zone);
  if (!pad.axes[Number(number)]) return 0; // browsers report 0 until an axis has moved
  return Math.min(1, Math.max(0, ((value + 1) / 2 - zone) / (1 - zone)));
}

/** All axes and buttons that can be assigned. */
export function sourcesOf(pad) {
  const axes = Array.from(pad.axes, (_, k) => [`axis ${k}`, `axis ${k} inverted`]).flat();
  return ["none", ...axes, ...Array.from(pad.buttons, (_, k) => `button ${k}`)];
}

/** The current device and its assignments. */
export class Gamepad {
  /** @param {() => (Data|null)[]} list `navigator.getGamepads` */
  constructor(list) {
    this._list = list;
    this.zone = 0.08;
    this.pad = null;
    this.assigned = {};
    this._id = null;
    this._before = null;
  }

  /**
   * Reads the devices.
   * @returns {{changed: boolean, touched: boolean}} whether the device is another one, and whether it was moved
   */
  poll() {
    const pads = [...(this._list() ?? [])].filter((pad) => pad && pad.connected !== false);
    this.pad = pads.find((pad) => pad.id === this._id) ?? pads[0] ?? null;
    const changed = (this.pad?.id ?? null) !== this._id;
    if (changed) {
      this._id = this.pad?.id ?? null;
      this.assigned = { ...(this.pad?.mapping === "standard" ? STANDARD : OTHER), ...loadAssigned(this._id) };
      this._before = null;
    }
    if (!this.pad) return { changed, touched: false };
    const now = [...this.pad.axes, ...this.pad.buttons.map((b) => b.value)];
    const touched = this._before !== null && now.some((v, k) => Math.abs(v - this._before[k]) > TAKEOVER_CHANGE);
    if (touched || this._before === null) this._before = now;
    return { changed, touched };
  }

  /** Assigns an axis or button to an input, and stores it for this device. */
  assign(name, source) {
    this.assigned[name] = source;
    try {
      localStorage.setItem(`ali3 gamepad ${this._id}`, JSON.stringify(this.assigned));
    } catch {
      // a page from disk may have no storage
    }
  }

  /** Requested values: input, value. */
  wants() {
    if (!this.pad) return [];
    return Object.entries(this.assigned)
      .filter(([, source]) => source !== "none")
      .map(([name, source]) => [name, readSource(this.pad, source, name !== "steering", this.zone)]);
  }
}

/** Assignments that were stored for a device. @param {string | null} id */
function loadAssigned(id) {
  try {
    return JSON.parse(localStorage.getItem(`ali3 gamepad ${id}`) ?? "{}");
  } catch {
    return {};
  }
}
