// Texts of the panel of devices, without elements of the page.

const HAT_DIRECTIONS = ["up", "right", "down", "left"];
const CENTRED_INPUTS = ["steering"];
const SELECTOR_PREFIX = "selector";
/** Parts of an axis: name, lowest and highest value. */
export const PARTS = [["whole axis", -1, 1], ["upper half", 0, 1], ["lower half", -1, 0]];

/** Instructions by input, for its assignment by a movement. */
const MOVE_INSTRUCTIONS = {
  steering: "turn the steering wheel to the left",
  throttle: "press the throttle down",
  brake: "press the brake down",
  hand_brake: "pull the hand brake",
};

/** The instruction while an input waits for a movement. @param {string} input @returns {string} */
export function movingWords(input) {
  return `${MOVE_INSTRUCTIONS[input] ?? `press the button for ${input}`} now`;
}

/** Whether an input runs from 0 to 1, as that of a pedal does. @param {string} input @returns {boolean} */
export function isPedal(input) {
  return !CENTRED_INPUTS.includes(input) && !input.startsWith(SELECTOR_PREFIX);
}

/**
 * Sources of a device that an input can have.
 * @param {{axes: number[], buttons: number[], hats?: number[]}} device
 * @param {string} input
 * @returns {string[]} "none" first.
 */
export function sourcesFor(device, input) {
  const axes = device.axes.map((_, k) => `axis ${k}`);
  const buttons = device.buttons.map((_, k) => `button ${k}`);
  const hats = (device.hats ?? []).flatMap((_, k) => HAT_DIRECTIONS.map((direction) => `hat ${k} ${direction}`));
  if (CENTRED_INPUTS.includes(input)) return ["none", ...axes];
  if (input.startsWith(SELECTOR_PREFIX)) return ["none", ...buttons, ...hats];
  return ["none", ...axes, ...buttons, ...hats];
}

/**
 * The mapping to request after another source was chosen.
 * @param {Data | undefined} old the mapping so far
 * @param {string} source
 * @param {string} input
 * @returns {Data | null}
 */
export function chosen(old, source, input) {
  if (source === "none") return null;
  if (!source.startsWith("axis")) return { source };
  const inverted = old?.source?.startsWith("axis") ? old.inverted : CENTRED_INPUTS.includes(input); // axes grow to the right
  return { source, inverted, low: -1, high: 1, dead_zone: old?.dead_zone ?? 0.03 };
}

/**
 * A mapping with some fields changed, in the form of a message: without fields that are for display only.
 * @param {Data} mapping
 * @param {Data} change
 */
export function changed(mapping, change) {
  const { source, inverted, low, high, dead_zone, centre } = { ...mapping, ...change };
  return { source, inverted, low, high, dead_zone, centre };
}

/** The name of the part of its axis that a mapping uses; "calibrated" where its ends are those of no part. */
export function partOf({ low, high }) {
  return PARTS.find(([, l, h]) => l === low && h === high)?.[0] ?? "calibrated";
}

/** Names of the inputs that an axis drives. */
export function drivenBy(device, axis) {
  return Object.keys(device.mapping).filter((input) => device.mapping[input].source === `axis ${axis}`);
}

/** Names of the pressed buttons and hats, in one text. */
export function pressedWords(device) {
  const buttons = device.buttons.flatMap((down, k) => (down ? [`button ${k}`] : []));
  const hats = (device.hats ?? []).flatMap((bits, k) => HAT_DIRECTIONS.flatMap((direction, b) => (bits & (1 << b) ? [`hat ${k} ${direction}`] : [])));
  return [...buttons, ...hats].join(", ") || "none";
}

/**
 * Left end and length of a bar, in percent of the width of its track.
 * @param {number} value where the bar ends
 * @param {number} low value at the left end of the track
 * @param {number} high value at its right end
 * @param {number} from where the bar begins
 */
export function barOf(value, low, high, from) {
  const place = (v) => (100 * (Math.min(high, Math.max(low, v)) - low)) / (high - low);
  const [a, b] = [place(from), place(value)].sort((x, y) => x - y);
  return { left: a, width: b - a };
}

/**
 * Whether the host already reads a gamepad of the browser, whose inputs would count twice.
 * @param {string} padId `Gamepad.id`, which contains the USB numbers of vendor and product
 * @param {{usb?: string}[]} devices
 */
export function readByHost(padId, devices) {
  const match = /Vendor: *([0-9a-f]{4}).*Product: *([0-9a-f]{4})/i.exec(padId) ?? /^([0-9a-f]{1,4})-([0-9a-f]{1,4})-/i.exec(padId);
  if (!match) return false;
  const usb = match.slice(1).map((number) => number.toLowerCase().padStart(4, "0")).join(":");
  return devices.some((device) => device.usb === usb);
}

/** All of a device but its moving values, as a text; the panel is drawn again when it changes. */
export function shapeOf(device) {
  const mapping = Object.fromEntries(Object.entries(device.mapping).map(([k, m]) => [k, changed(m, {})]));
  const { id, name, kind, force, force_problem, inputs, settings, assigning } = device;
  const counts = [device.axes.length, device.buttons.length, (device.hats ?? []).length];
  return JSON.stringify([id, name, kind, force, force_problem, inputs, settings, assigning, mapping, counts, device.calibration?.stage]);
}
