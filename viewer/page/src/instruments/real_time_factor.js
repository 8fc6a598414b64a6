// The real-time factor of a run as text.
import { short } from "../common/dom.js";

/** Beyond this the machine does not keep up. */
const SLOW = 0.97;

/**
 * What the machine does, in words; a warning where it is slower than asked for.
 * @param {{running: boolean, speed: number, factor: number | null}} pace `factor`: simulated seconds per second of the clock
 */
export function realTimeText({ running, speed, factor }) {
  const nominal = speed === 1 ? "real time" : speed < 1 ? `slow motion × ${short(speed)}` : `fast × ${short(speed)}`;
  if (!running) return { text: "paused", warn: "" };
  const late = factor !== null && factor < SLOW * speed;
  const warn = late ? `This machine does not keep up: ${factor.toFixed(2)} s of the run a second, ${short(speed)} asked for.` : "";
  return { text: factor === null ? nominal : `${nominal} (× ${factor.toFixed(2)})`, warn };
}
