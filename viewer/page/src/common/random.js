// Pseudo-random numbers, the same on every machine.

/** Generator mulberry32 (T. Ettinger). @param {number} seed whole @returns {() => number} the next number, from 0 to below 1 */
export function randomNumbers(seed) {
  let state = (seed ^ 0x9e3779b9) >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let x = Math.imul(state ^ (state >>> 15), 1 | state);
    x = (x + Math.imul(x ^ (x >>> 7), 61 | x)) ^ x;
    return ((x ^ (x >>> 14)) >>> 0) / 4294967296;
  };
}
