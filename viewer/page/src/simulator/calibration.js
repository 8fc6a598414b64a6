// The panel of the host's input devices: bars of their axes, assignment of inputs, calibration and settings of the force.
import { button, el, fixed, named, select, short } from "../common/dom.js";
import { section } from "../live/panel.js";
import { styled } from "../styles.js";
import style from "./calibration.css";
import { barOf, changed, chosen, drivenBy, isPedal, movingWords, PARTS, partOf, pressedWords, shapeOf, sourcesFor } from "./device_words.js";

/** Settings of a device: name, words, unit, lowest, highest, step. */
const SETTINGS = [
  ["rotation", "turn of the wheel from end to end (0: as it is)", "deg", 0, 3600, 10],
  ["force", "force", "", 0, 5, 0.1],
  ["full_torque", "torque of the car at full force", "N m", 0.1, 100, 0.5],
  ["smoothing", "smoothing of the force", "s", 0, 1, 0.005],
  ["damper", "damper", "", 0, 1, 0.05],
  ["spring", "spring while the car rests", "", 0, 1, 0.05],
];
const TEST_INSTRUCTION = "The wheel should turn to the left for a moment. If it turns to the right, tick “force inverted”.";
const NO_DEVICES = "No steering wheel, pedals or gamepad is plugged in at the computer that runs the car.";

/** The panel. `element` goes into the page; `show` updates it with the host's message “devices”. */
export class CalibrationPanel {
  /** @param {object} options @param {(message: Data) => void} options.send takes messages to the host */
  constructor({ send }) {
    styled(style);
    this._send = send;
    this._parts = new Map();
    this._noDevices = el("p.a3-hint", { data: "no devices" }, NO_DEVICES);
    this._list = el("div", {}, this._noDevices);
    this.element = section("Devices", true, el("div.a3-devices", {}, this._list));
  }

  /** Shows the devices that are plugged in. @param {Data[]} devices as in the host's message “devices” */
  show(devices) {
    const ids = new Set(devices.map(({ id }) => id));
    for (const [id, part] of this._parts) {
      if (ids.has(id)) continue;
      part.element.remove();
      this._parts.delete(id);
    }
    for (const device of devices) {
      if (!this._parts.has(device.id)) {
        this._parts.set(device.id, new DevicePart(this._send));
        this._list.append(this._parts.get(device.id).element);
      }
      this._parts.get(device.id).show(device);
    }
    this._noDevices.hidden = devices.length > 0;
  }
}

/** The part of the panel for one device. */
class DevicePart {
  constructor(send) {
    this._send = send;
    this._shape = "";
    this._busy = false;
    this._body = el("div");
    this._body.addEventListener("input", () => (this._busy = true));
    this._body.addEventListener("focusin", ({ target }) => (this._busy = target instanceof HTMLSelectElement));
    for (const end of ["change", "focusout"]) this._body.addEventListener(end, () => (this._busy = false));
    this._title = el("summary");
    this.element = el("details.a3-section", { open: true }, this._title, this._body);
  }

  /** Shows a new state of the device. @param {Data} device */
  show(device) {
    this.device = device;
    const shape = shapeOf(device);
    const focused = this._body.contains(document.activeElement) ? document.activeElement : null;
    // A field in use is not replaced: the panel is drawn again once typing, dragging or choosing has ended.
    if (shape !== this._shape && !(this._busy && this._shape)) {
      this._shape = shape;
      const open = new Map([...this._body.querySelectorAll("details")].map((part) => [part.getAttribute("data-a3"), part.open]));
      this._draw(device);
      for (const part of this._body.querySelectorAll("details")) part.open = open.get(part.getAttribute("data-a3")) ?? part.open;
      const focusedName = focused?.getAttribute("data-a3");
      /** @type {HTMLElement | null} */
      const replacement = focusedName ? this._body.querySelector(`[data-a3="${CSS.escape(focusedName)}"]`) : null;
      replacement?.focus();
    }
    this._update(device);
  }

  /** Sends a message about this device. */
  _sendMessage(type, more = {}) {
    this._send({ type, device: this.device.id, ...more });
  }

  _assign(input, mapping) {
    this._sendMessage("assign", { input, mapping });
  }

  _draw(device) {
    this._updates = [];
    this._title.textContent = `${device.name} (${device.kind})`;
    this.element.setAttribute("data-a3", `device ${device.name}`);
    const lines = device.inputs.map((input) => this._input(device, input));
    const axes = device.axes.map((_, k) => this._axis(device, k));
    const pressed = el("small", { data: "pressed" });
    this._updates.push((d) => (pressed.textContent = `pressed: ${pressedWords(d)}`));
    this._body.replaceChildren(
      this._calibration(device),
      ...lines,
      section("Axes and buttons", true, ...axes, pressed),
      section("Wheel and force", false, ...this._settings(device)),
      el("div.a3-device-buttons", {}, button("reset mapping", "Back to the first guess", () => this._sendMessage("reset mapping"))),
    );
  }

  _update(device) {
    for (const update of this._updates) update(device);
  }

  /** The button that begins a calibration; during one, its instruction and buttons. */
  _calibration(device) {
    if (!device.calibration) {
      const begin = button("calibrate", "Calibrate", () => this._sendMessage("calibrate", { on: true }));
      return el("div.a3-device-buttons", {}, begin, el("span.a3-hint", {}, "finds the ends of every axis that drives something"));
    }
    const words = el("p", { data: "calibration" });
    this._updates.push((d) => (words.textContent = d.calibration?.text ?? ""));
    const finish = button("finish", "Finish", () => this._sendMessage("calibrate", { on: false }));
    finish.disabled = device.calibration.stage === "rest";
    const cancel = button("cancel", "Cancel", () => this._sendMessage("calibrate", { on: false, keep: false }));
    return el("div.a3-device-do", {}, words, el("div.a3-device-buttons", {}, finish, cancel));
  }

  /** The line of an input: its source, its value and, for an axis, its options. */
  _input(device, input) {
    const mapping = device.mapping[input];
    const assign = (source) => this._assign(input, chosen(this.device.mapping[input], source, input));
    const source = select(`source ${input}`, `what drives ${input}`, named(sourcesFor(device, input)), assign, mapping?.source ?? "none");
    const waiting = device.assigning === input;
    const move = button(`move ${input}`, waiting ? "Cancel" : "Move it now", () => this._sendMessage("assign by moving", { input, on: !waiting }));
    const children = [el("span", {}, input), source, move];
    if (waiting) children.push(el("span.a3-device-more", { data: "moving" }, movingWords(input)));
    if (mapping && !input.startsWith("selector")) {
      const bar = track(`value ${input}`);
      const low = isPedal(input) ? 0 : -1;
      // Positive steering is to the left, and so is its bar.
      this._updates.push((d) => bar.set(barOf((low ? -1 : 1) * (d.mapping[input]?.value ?? 0), low, 1, 0)));
      children.push(bar.element);
    }
    if (mapping?.source.startsWith("axis")) children.push(this._axisChoices(input, mapping));
    return el("div.a3-device-line", { data: `input ${input}` }, ...children);
  }

  /** Options of an axis: inversion, dead zone and, for a pedal, the part of the axis. */
  _axisChoices(input, mapping) {
    const current = () => this.device.mapping[input];
    const inverted = el("input", { type: "checkbox", checked: mapping.inverted, data: `inverted ${input}` });
    inverted.addEventListener("change", () => {
      this._assign(input, changed(current(), { inverted: inverted.checked }));
    });
    const zone = el("input", { type: "range", min: 0, max: 0.5, step: 0.01, value: mapping.dead_zone, data: `dead zone ${input}` });
    zone.addEventListener("change", () => {
      this._assign(input, changed(current(), { dead_zone: Number(zone.value) }));
    });
    /** @type {HTMLElement[]} */
    const parts = [el("label", {}, inverted, "inverted"), el("label", {}, "dead zone", zone, short(mapping.dead_zone))];
    if (isPedal(input)) {
      const names = [...PARTS.map(([name]) => String(name)), ...(partOf(mapping) === "calibrated" ? ["calibrated"] : [])];
      const setPart = (part) => {
        const match = PARTS.find(([name]) => name === part);
        if (match) this._assign(input, changed(current(), { low: match[1], high: match[2] }));
      };
      parts.push(select(`part ${input}`, `part of the axis for ${input}`, named(names), setPart, partOf(mapping)));
    }
    return el("div.a3-device-more", {}, ...parts);
  }

  /** The line of an axis: its raw value, with marks at the ends of the inputs that it drives. */
  _axis(device, k) {
    const bar = track(`axis ${k}`);
    const number = el("span");
    const driven = drivenBy(device, k);
    for (const input of driven) {
      for (const end of ["low", "high"]) bar.mark(barOf(device.mapping[input][end], -1, 1, -1).width);
    }
    this._updates.push((d) => {
      bar.set(barOf(d.axes[k] ?? 0, -1, 1, 0));
      number.textContent = fixed(d.axes[k] ?? 0, 3);
    });
    const words = el("small", { data: `driven ${k}` }, driven.length ? `drives ${driven.join(", ")}` : "drives nothing");
    return el("div.a3-axis", {}, el("span", {}, `axis ${k}`), bar.element, number, words);
  }

  _settings(device) {
    const lines = SETTINGS.map(([name, words, unit, min, max, step]) => {
      const field = el("input", { type: "number", min, max, step, value: device.settings[name], data: `setting ${name}` });
      field.addEventListener("change", () => {
        this._sendMessage("device settings", { settings: { [name]: Number(field.value) } });
      });
      return [el("span", {}, words), field, el("span", {}, unit)];
    });
    const inverted = el("input", { type: "checkbox", checked: device.settings.force_inverted, data: "force inverted" });
    inverted.addEventListener("change", () => {
      this._sendMessage("device settings", { settings: { force_inverted: inverted.checked } });
    });
    const forceText = el("p.a3-hint", { data: "force" });
    forceText.textContent = device.force ? "Its motor works." : `No force${device.force_problem ? `: ${device.force_problem}` : ""}.`;
    const words = el("p.a3-hint", { data: "force test", hidden: true }, TEST_INSTRUCTION);
    const test = button("test force", "Test the force", () => {
      words.hidden = false;
      this._sendMessage("test force");
    });
    test.disabled = !device.force;
    return [el("div.a3-device-settings", {}, ...lines.flat()), el("label.a3-control", {}, inverted, "force inverted"), forceText, test, words];
  }
}

/** A bar with `set` for its extent and `mark` for a line, both in percent of the width. */
function track(data) {
  const bar = el("i");
  const element = el("div.a3-track", { data }, bar);
  return {
    element,
    set: ({ left, width }) => Object.assign(bar.style, { left: `${left}%`, width: `${width}%` }),
    mark: (percent) => {
      const mark = el("u");
      mark.style.left = `min(${percent}%, 100% - 1px)`;
      element.append(mark);
    },
  };
}
