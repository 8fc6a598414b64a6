// The real-time factor of a run as text.
import { short } from "../common/dom.js";

/** Ratio to the requested speed below which the machine is too slow. */
const SLOW_RATIO = 0.97;

/**
 * Text of the real-time factor, and a warning if the machine is too slow.
 * @param {{running: boolean, speed: number, factor: number | null}} pace `factor`: simulated seconds per second of the clock
 */
export function realTimeText({ running, speed, factor }) {
  const nominal = speed === 1 ? "real time" : speed < 1 ? `slow motion × ${short(speed)}` : `fast × ${short(speed)}`;
  if (!running) return { text: "paused", warn: "" };
  const late = factor !== null && factor < SLOW_RATIO * speed;
  const warn = late ? `This machine does not keep up: ${factor.toFixed(2)} s of the run a second, ${short(speed)} asked for.` : "";
  return { text: factor === null ? nominal : `${nominal} (× ${factor.toFixed(2)})`, warn };
}
