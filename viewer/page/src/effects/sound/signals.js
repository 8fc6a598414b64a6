// Computes pitches in Hz and levels from 0 to 1 of the sounds of a car from its signals.
import { LIGHT, use } from "../wheels.js";

/** Firings per revolution of a four-stroke engine with four cylinders. */
const FIRINGS = 2;
/** Idle speed, rad/s, least speed of the sound. */
export const IDLE = 85;
/** Periods per revolution of the sound of an electric motor: two per pair of poles. */
export const WAVES = 8;
/** Load of the largest level of a tyre, N. */
const FULL_LOAD = 3000;
/** Least rate of change of a wheel's load that is audible as an impact, and that of the loudest, N/s. */
const [LEAST_RATE, LOUDEST_RATE] = [60e3, 600e3];

/** Crank speed of the loudest engine, and rotor speed of the loudest motor, rad/s. */
const [LOUD_ENGINE, LOUD_MOTOR] = [600, 120];
/** Use of the largest force of a tyre from which it squeals, and the further use up to the loudest squeal. */
const [SQUEAL_USE, SQUEAL_RANGE] = [0.9, 1.6];
/** Speeds of the loudest rolling noise and of the loudest wind, m/s. */
const [LOUD_ROLLING, LOUD_WIND] = [40, 45];

const clamp = (value) => Math.min(1, Math.max(0, value));

/** Pitch of an engine: firings per second. @param {number} speed of the crank, rad/s */
export const enginePitch = (speed) => (FIRINGS * Math.max(IDLE, Math.abs(speed))) / (2 * Math.PI);

/** Levels of an engine without and with load. @param {number} speed rad/s @param {number} throttle 0 to 1 */
export function engineLevels(speed, throttle) {
  const turning = clamp(Math.max(IDLE, Math.abs(speed)) / LOUD_ENGINE);
  const load = clamp(throttle);
  return { calm: 0.16 + 0.1 * turning * (1 - load), loaded: load * (0.12 + 0.34 * turning) };
}

/** Pitch of an electric motor, proportional to its speed. @param {number} speed of the rotor, rad/s */
export const motorPitch = (speed) => (WAVES * Math.abs(speed)) / (2 * Math.PI);

/** Level of the whine of an electric motor. @param {number} speed rad/s @param {number} effort torque over the largest, or the throttle */
export const motorLevel = (speed, effort) => clamp(Math.abs(speed) / LOUD_MOTOR) * (0.035 + 0.13 * clamp(Math.abs(effort)));

/**
 * Level of the squeal of a tyre: 0 below nine tenths of its limit, then rising with slip and load.
 * @param {number} slip longitudinal @param {number} angle slip angle, rad @param {number} load N
 * @param {number} speed of the car or of the tread, m/s
 */
export function squealLevel(slip, angle, load, speed) {
  if (!(load > LIGHT)) return 0;
  return clamp((use(slip, angle) - SQUEAL_USE) / SQUEAL_RANGE) * clamp(load / FULL_LOAD) ** 0.7 * clamp((speed - 1) / 3);
}

/** Pitch of squeal, falling with the load. @param {number} load N */
export const squealPitch = (load) => 1050 - 330 * clamp(load / (2 * FULL_LOAD));

/** Level of rolling noise. @param {number} speed m/s @param {number} share of the wheels that touch the ground */
export const rollingLevel = (speed, share) => 0.3 * clamp(Math.abs(speed) / LOUD_ROLLING) ** 0.8 * share;

/** Level of wind, proportional to the square of the speed. @param {number} speed m/s */
export const windLevel = (speed) => 0.4 * clamp(Math.abs(speed) / LOUD_WIND) ** 2;

/** Level of an impact from the previous and the current load of a wheel. @param {number} before N @param {number} now N @param {number} step s */
export function thumpLevel(before, now, step) {
  if (!(step > 0)) return 0;
  const rate = (now - before) / step;
  return rate <= LEAST_RATE ? 0 : 0.15 + 0.85 * clamp((rate - LEAST_RATE) / (LOUDEST_RATE - LEAST_RATE));
}
