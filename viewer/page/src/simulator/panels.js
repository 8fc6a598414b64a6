// The panels at the side: devices, the gamepad of the browser, the report, the picture, the recording.
import { el } from "../common/dom.js";
import { gamepadPanel, picturePanel, section } from "../live/panel.js";
import { CalibrationPanel } from "./calibration.js";
import { Report } from "./report.js";

/** What opens at the side of the picture. */
export class Panels {
  /**
   * @param {object} options
   * @param {import("../live/gamepad.js").Gamepad} options.gamepad - Of the browser.
   * @param {string[]} options.inputs
   * @param {object} options.has - What the picture can show; see SceneView.
   * @param {(wishes: Data) => void} options.set - What it shall show.
   * @param {(message: Data) => void} options.send
   * @param {string} options.recording - Path, or empty.
   */
  constructor({ gamepad, inputs, has, set, send, recording }) {
    this._send = send;
    this.gamepad = gamepadPanel(gamepad, inputs);
    this.report = new Report(() => send({ type: "report" }));
    this.picture = picturePanel([has], set);
    this._devices = new CalibrationPanel({ send });
    const record = el("p", { data: "recording" }, recording ? `Everything is recorded in ${recording}` : "Nothing is recorded.");
    const parts = [section("Report", true, this.report.element), section("Recording", true, record)];
    this.element = el("div.a3-panels", { data: "panel", hidden: true }, ...(this.picture ? [this.picture] : []), this._devices.element, ...parts, this.gamepad.element);
  }

  /** @param {boolean} [open] */
  toggle(open = this.element.hidden === true) {
    this.element.hidden = !open;
    this._send({ type: "watch devices", on: open });
    if (open) this._send({ type: "report" });
  }

  /** Devices of the host. @param {Data[]} devices */
  devices(devices) {
    this._devices.show(devices);
  }

  /** A switch of the picture, as if it was clicked at. @param {"arrows" | "stress" | "closed"} what @returns {boolean} Whether there is one. */
  flip(what) {
    /** @type {HTMLElement | null | undefined} */
    const box = this.picture?.querySelector(`[data-a3="show ${what}"]`);
    box?.click();
    return Boolean(box);
  }
}
