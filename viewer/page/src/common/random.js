// Pseudo-random numbers, the same on every machine.
import { MathUtils } from "three";

/** Generator mulberry32 of three.js. @param {number} seed whole @returns {() => number} the next number, from 0 to below 1 */
export function randomNumbers(seed) {
  let state = (seed ^ 0x9e3779b9) >>> 0;
  return () => {
    const number = MathUtils.seededRandom(state);
    state = (state + 0x6d2b79f5) >>> 0; // seededRandom adds this number itself
    return number;
  };
}
