// Arbitrates between keys and a gamepad at the inputs of a car: the source that moved last has control.
import { Keyboard, RATES } from "./keyboard.js";
import { Gamepad } from "./gamepad.js";

/** Hands are asked by a clock of their own, ms: a picture that takes long holds no pedal. */
export const ARBITER_MS = 16;

/** Keys and gamepad of a page. */
export class InputArbiter {
  /**
   * @param {object} options
   * @param {string[]} options.inputs - Of the FMU; what is not an input is not asked for.
   * @param {Object<string, number> | null} options.constants - Of a car; null: keys do nothing.
   * @param {() => (Data | null)[]} [options.pads] - `navigator.getGamepads`.
   * @param {(source: string, wants: [string, number, number?][]) => void} options.want - Input, value, largest change
   *   per second (none: at once), of "keys" or "gamepad".
   */
  constructor({ inputs, constants, pads = () => navigator.getGamepads?.() ?? [], want }) {
    this._inputs = new Set(inputs);
    this._want = want;
    this.keyboard = constants && new Keyboard(constants);
    this.gamepad = new Gamepad(pads);
    this._slid = new Set();
    this._keyed = false;
    this._padded = false;
  }

  /** A slider has the word for an input, until a key or the gamepad moves it. */
  hold(name) {
    this._slid.add(name);
  }

  /**
   * A key goes down or up.
   * @param {{code: string, type: string, shiftKey?: boolean, repeat?: boolean}} event - Of the keyboard.
   * @param {number} speed - Of the car, m/s.
   * @returns {boolean} Whether it is a key for driving.
   */
  key(event, speed) {
    const { used, selector } = this.keyboard?.key(event.code, event.type === "keydown", event.shiftKey) ?? { used: false };
    if (!used || event.repeat) return used;
    if (selector !== undefined && this._inputs.has("selector")) this._want("keys", [["selector", selector]]);
    this._slid.clear();
    this._wantKeys(speed);
    return true;
  }

  /** Keys that are down count as up, as when the page loses the focus. */
  letKeysGo() {
    if (!this._keyed) return;
    this.keyboard.clear();
    this._wantKeys(0);
  }

  /** The gamepad is as if nobody touched it, as when its page is hidden or it is pulled out. */
  letGamepadGo() {
    if (!this._padded) return;
    this._padded = false;
    const moved = Object.entries(this.gamepad.assigned).filter(([name, source]) => source !== "none" && RATES[name]);
    this._ask("gamepad", moved.map(([name]) => [name, 0, RATES[name][1]])); // prettier-ignore
  }

  /** No key is down and no rate holds, as at a new start. */
  clear() {
    this.keyboard?.clear();
  }

  /**
   * Look at the devices; called for each picture.
   * @param {number} speed - Of the car, m/s.
   * @returns {{changed: boolean, lost: boolean}} Whether another gamepad is there now, and whether one that drove went.
   */
  poll(speed) {
    const { assigned } = this.gamepad;
    const { changed, touched } = this.gamepad.poll();
    const lost = changed && this._padded && !this.gamepad.pad;
    if (lost) {
      const now = this.gamepad.assigned;
      this.gamepad.assigned = assigned;
      this.letGamepadGo();
      this.gamepad.assigned = now;
    }
    if (touched) this._slid.clear();
    if (touched || (this._padded && this.gamepad.pad)) {
      this._ask("gamepad", this.gamepad.wants());
      this._padded = !this._keyed;
    }
    if (this._keyed) this._wantKeys(speed); // the steering limit follows the speed
    return { changed, lost };
  }

  _wantKeys(speed) {
    const wants = this.keyboard.wants(Math.abs(speed) || 0);
    this._keyed = wants.some(([, value]) => value !== 0);
    this._ask("keys", wants);
  }

  _ask(source, wants) {
    const asked = wants.filter(([name]) => this._inputs.has(name) && !this._slid.has(name));
    if (asked.length) this._want(source, asked);
  }
}
