// Pitches and levels of the sounds of a car from its signals: pitches in Hz and levels from 0 to 1; pure numbers.
import { LIGHT, use } from "../wheels.js";

/** Firings of a four-stroke engine of four cylinders a revolution. */
const FIRINGS = 2;
/** Speed of an engine that idles, rad/s: slower it is not heard. */
export const IDLE = 85;
/** Waves of an electric motor a revolution: pairs of poles times two. */
export const WAVES = 8;
/** Load at which a tyre is as loud as it gets, N. */
const LOAD = 3000;
/** Jump of a wheel's load in one second that makes a thump, and that of the loudest, N/s. */
const [KNOCK, BANG] = [60e3, 600e3];

const clamp = (value) => Math.min(1, Math.max(0, value));

/** Pitch of an engine: its firings a second. @param {number} speed of the crank, rad/s */
export const enginePitch = (speed) => (FIRINGS * Math.max(IDLE, Math.abs(speed))) / (2 * Math.PI);

/** Levels of an engine without and with load. @param {number} speed rad/s @param {number} throttle 0 to 1 */
export function engineLevels(speed, throttle) {
  const turning = clamp(Math.max(IDLE, Math.abs(speed)) / 600);
  const load = clamp(throttle);
  return { calm: 0.16 + 0.1 * turning * (1 - load), loaded: load * (0.12 + 0.34 * turning) };
}

/** Pitch of an electric motor: rises from 0 with its speed. @param {number} speed of the rotor, rad/s */
export const motorPitch = (speed) => (WAVES * Math.abs(speed)) / (2 * Math.PI);

/** Level of its whine. @param {number} speed rad/s @param {number} effort torque over the largest, or the throttle */
export const motorLevel = (speed, effort) => clamp(Math.abs(speed) / 120) * (0.035 + 0.13 * clamp(Math.abs(effort)));

/**
 * Level of the squeal of one tyre: nothing below nine tenths of its limit, then louder the more it slips and carries.
 * @param {number} slip longitudinal @param {number} angle slip angle, rad @param {number} load N
 * @param {number} speed of the car or of the tread, m/s
 */
export function squealLevel(slip, angle, load, speed) {
  if (!(load > LIGHT)) return 0;
  return clamp((use(slip, angle) - 0.9) / 1.6) * clamp(load / LOAD) ** 0.7 * clamp((speed - 1) / 3);
}

/** Pitch of squeal: lower the more it is loaded. @param {number} load N */
export const squealPitch = (load) => 1050 - 330 * clamp(load / (2 * LOAD));

/** Level of rolling noise. @param {number} speed m/s @param {number} share of the wheels that touch the ground */
export const rollingLevel = (speed, share) => 0.3 * clamp(Math.abs(speed) / 40) ** 0.8 * share;

/** Level of wind: with the square of the speed. @param {number} speed m/s */
export const windLevel = (speed) => 0.4 * clamp(Math.abs(speed) / 45) ** 2;

/** Level of a thump, from a wheel's load before and now. @param {number} before N @param {number} now N @param {number} step s */
export function thumpLevel(before, now, step) {
  if (!(step > 0)) return 0;
  const rate = (now - before) / step;
  return rate <= KNOCK ? 0 : 0.15 + 0.85 * clamp((rate - KNOCK) / (BANG - KNOCK));
}
