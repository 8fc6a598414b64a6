// Arbitrates between keys and a gamepad at the inputs of a car: the source that moved last has control.
import { Keyboard, RATES } from "./keyboard.js";
import { Gamepad } from "./gamepad.js";

/** Interval of reading the devices, independent of pictures, ms. */
export const ARBITER_MS = 16;

/** Arbiter of the keys and the gamepad of a page. */
export class InputArbiter {
  /**
   * @param {object} options
   * @param {string[]} options.inputs inputs of the FMU; others are not requested
   * @param {Object<string, number> | null} options.constants of a car; null: keys have no effect
   * @param {() => (Data | null)[]} [options.pads] `navigator.getGamepads`
   * @param {(source: string, wants: [string, number, number?][]) => void} options.want input, value, largest change
   *   per second (none: at once), of "keys" or "gamepad".
   */
  constructor({ inputs, constants, pads = () => navigator.getGamepads?.() ?? [], want }) {
    this._inputs = new Set(inputs);
    this._want = want;
    this.keyboard = constants && new Keyboard(constants);
    this.gamepad = new Gamepad(pads);
    this._heldBySlider = new Set();
    this._keysControl = false;
    this._gamepadControls = false;
  }

  /** Gives a slider control of an input, until a key or the gamepad moves it. */
  hold(name) {
    this._heldBySlider.add(name);
  }

  /**
   * Handles a key press or release.
   * @param {{code: string, type: string, shiftKey?: boolean, repeat?: boolean}} event of the keyboard
   * @param {number} speed of the car, m/s
   * @returns {boolean} whether it is a key for driving
   */
  key(event, speed) {
    const { used, selector } = this.keyboard?.key(event.code, event.type === "keydown", event.shiftKey) ?? { used: false };
    if (!used || event.repeat) return used;
    if (selector !== undefined && this._inputs.has("selector")) this._want("keys", [["selector", selector]]);
    this._heldBySlider.clear();
    this._wantKeys(speed);
    return true;
  }

  /** Releases all keys, as when the page loses the focus. */
  letKeysGo() {
    if (!this._keysControl) return;
    this.keyboard.clear();
    this._wantKeys(0);
  }

  /** Releases the gamepad, as when its page is hidden or it is unplugged. */
  letGamepadGo() {
    if (!this._gamepadControls) return;
    this._gamepadControls = false;
    const moved = Object.entries(this.gamepad.assigned).filter(([name, source]) => source !== "none" && RATES[name]);
    this._request("gamepad", moved.map(([name]) => [name, 0, RATES[name][1]])); // prettier-ignore
  }

  /** Releases all keys without requests, as at a restart. */
  clear() {
    this.keyboard?.clear();
  }

  /**
   * Reads the devices.
   * @param {number} speed of the car, m/s
   * @returns {{changed: boolean, lost: boolean}} whether the gamepad is another one, and whether one in control was unplugged
   */
  poll(speed) {
    const { assigned } = this.gamepad;
    const { changed, touched } = this.gamepad.poll();
    const lost = changed && this._gamepadControls && !this.gamepad.pad;
    if (lost) {
      const now = this.gamepad.assigned;
      this.gamepad.assigned = assigned;
      this.letGamepadGo();
      this.gamepad.assigned = now;
    }
    if (touched) this._heldBySlider.clear();
    if (touched || (this._gamepadControls && this.gamepad.pad)) {
      this._request("gamepad", this.gamepad.wants());
      this._gamepadControls = !this._keysControl;
    }
    if (this._keysControl) this._wantKeys(speed); // the steering limit follows the speed
    return { changed, lost };
  }

  _wantKeys(speed) {
    const wants = this.keyboard.wants(Math.abs(speed) || 0);
    this._keysControl = wants.some(([, value]) => value !== 0);
    this._request("keys", wants);
  }

  _request(source, wants) {
    const allowed = wants.filter(([name]) => this._inputs.has(name) && !this._heldBySlider.has(name));
    if (allowed.length) this._want(source, allowed);
  }
}
