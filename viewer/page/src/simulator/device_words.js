// Texts of the panel of devices, without elements of the page.

const HAT = ["up", "right", "down", "left"];
const CENTRED = ["steering"];
const SELECTOR = "selector";
/** Parts of an axis: name, lowest and highest value. */
export const PARTS = [["whole axis", -1, 1], ["upper half", 0, 1], ["lower half", -1, 0]];

/** What a person moves for an input. */
const MOVE_WORDS = {
  steering: "turn the steering wheel to the left",
  throttle: "press the throttle down",
  brake: "press the brake down",
  hand_brake: "pull the hand brake",
};

/** The words while an input waits for a movement. */
export function movingWords(input) {
  return `${MOVE_WORDS[input] ?? `press the button for ${input}`} now`;
}

/** Whether an input is a pedal: from 0 to 1. */
export function isPedal(input) {
  return !CENTRED.includes(input) && !input.startsWith(SELECTOR);
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
  const hats = (device.hats ?? []).flatMap((_, k) => HAT.map((direction) => `hat ${k} ${direction}`));
  if (CENTRED.includes(input)) return ["none", ...axes];
  if (input.startsWith(SELECTOR)) return ["none", ...buttons, ...hats];
  return ["none", ...axes, ...buttons, ...hats];
}

/**
 * The mapping to ask for when a person chooses another source.
 * @param {Data | undefined} old - The mapping so far.
 * @param {string} source
 * @param {string} input
 * @returns {Data | null}
 */
export function chosen(old, source, input) {
  if (source === "none") return null;
  if (!source.startsWith("axis")) return { source };
  const inverted = old?.source?.startsWith("axis") ? old.inverted : CENTRED.includes(input); // axes grow to the right
  return { source, inverted, low: -1, high: 1, dead_zone: old?.dead_zone ?? 0.03 };
}

/**
 * The mapping with some fields changed, as it is sent: without what is only shown.
 * @param {Data} mapping
 * @param {Data} change
 */
export function changed(mapping, change) {
  const { source, inverted, low, high, dead_zone, centre } = { ...mapping, ...change };
  return { source, inverted, low, high, dead_zone, centre };
}

/** The name of the part of its axis that a mapping uses; "calibrated" where the ends are others. */
export function partOf({ low, high }) {
  return PARTS.find(([, l, h]) => l === low && h === high)?.[0] ?? "calibrated";
}

/** Which inputs an axis drives. */
export function drivenBy(device, axis) {
  return Object.keys(device.mapping).filter((input) => device.mapping[input].source === `axis ${axis}`);
}

/** Buttons and hats that are pressed, as words. */
export function pressedWords(device) {
  const buttons = device.buttons.flatMap((down, k) => (down ? [`button ${k}`] : []));
  const hats = (device.hats ?? []).flatMap((bits, k) => HAT.flatMap((direction, b) => (bits & (1 << b) ? [`hat ${k} ${direction}`] : [])));
  return [...buttons, ...hats].join(", ") || "none";
}

/**
 * Where a bar begins and how long it is, in percent of its width.
 * @param {number} value
 * @param {number} low - Left end.
 * @param {number} high
 * @param {number} from - Where the bar begins.
 */
export function barOf(value, low, high, from) {
  const place = (v) => (100 * (Math.min(high, Math.max(low, v)) - low)) / (high - low);
  const [a, b] = [place(from), place(value)].sort((x, y) => x - y);
  return { left: a, width: b - a };
}

/**
 * Whether a gamepad of the browser is a device that the host reads already: it would drive twice.
 * @param {string} padId - `Gamepad.id`, which has the numbers of maker and product.
 * @param {{usb?: string}[]} devices
 */
export function readByHost(padId, devices) {
  const found = /Vendor: *([0-9a-f]{4}).*Product: *([0-9a-f]{4})/i.exec(padId) ?? /^([0-9a-f]{1,4})-([0-9a-f]{1,4})-/i.exec(padId);
  if (!found) return false;
  const usb = found.slice(1).map((number) => number.toLowerCase().padStart(4, "0")).join(":");
  return devices.some((device) => device.usb === usb);
}

/** Everything of a device but what moves: where it differs the panel is drawn again. */
export function shapeOf(device) {
  const mapping = Object.fromEntries(Object.entries(device.mapping).map(([k, m]) => [k, changed(m, {})]));
  const { id, name, kind, force, force_problem, inputs, settings, assigning } = device;
  const counts = [device.axes.length, device.buttons.length, (device.hats ?? []).length];
  return JSON.stringify([id, name, kind, force, force_problem, inputs, settings, assigning, mapping, counts, device.calibration?.stage]);
}
