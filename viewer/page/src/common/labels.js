// Places labels beside points of a picture.

/** Vertical offsets of labels in their heights, in the order of trial, and horizontal distance from their dot, pixels. */
const [OFFSETS, GAP] = [[0, 1, -1, 2, -2, 3, -3], 8];
/** Half the side of a dot, pixels. */
const DOT_HALF_SIDE = 5;
/** Cost of overlap with dots or the outside of the picture, relative to that of labels with each other. */
const DOT_COST = 10;
/** Additional cost of each later position, and bonus of the previous position, both as shares of the area. */
const [ORDER_COST, PREVIOUS_BONUS] = [0.001, 0.1];

/** Common area of two boxes. @param {number[]} one left, top, right, bottom @param {number[]} other */
const commonArea = (one, other) => [0, 1].map((k) => Math.max(0, Math.min(one[k + 2], other[k + 2]) - Math.max(one[k], other[k]))).reduce((a, b) => a * b);

/**
 * Positions of labels with the least overlap of each other, of dots and of boxes over the picture, found one by one.
 * @param {{at: number[], size: number[], above?: number[], sides?: number[], spot?: string}[]} labels
 *   at: the dot, pixels; size: width and height; above: height of their top above the dot, in their heights and in
 *   pixels; sides: right of it (1), left (-1), across it (0), best first; spot: the previous result
 * @param {number[]} picture width and height
 * @param {number[][]} [over] boxes over the picture
 * @returns {{spot: string, left: number, top: number}[]}
 */
export function besides(labels, picture, over = []) {
  const dots = labels.map(({ at: [x, y] }) => [x - DOT_HALF_SIDE, y - DOT_HALF_SIDE, x + DOT_HALF_SIDE, y + DOT_HALF_SIDE]);
  const occupied = [...over];
  return labels.map(({ at: [x, y], size: [width, height], above: [share, more] = [0.5, 0], sides = [1, -1, 0], spot: now }) => {
    const area = width * height || 1; // 0 while the page is hidden
    const spots = OFFSETS.flatMap((offset) => sides.map((side, k) => {
      const beside = x + side * GAP - ((1 - side) / 2) * width;
      const [left, top] = [Math.max(0, Math.min(beside, picture[0] - width)), y - (share + offset) * height - more];
      const box = [left, top, left + width, top + height];
      const overlap = (/** @type {number[][]} */ boxes) => boxes.reduce((sum, one) => sum + commonArea(one, box), 0);
      const spot = `${side} ${offset}`;
      const bias = ORDER_COST * (sides.length * OFFSETS.indexOf(offset) + k) - (spot === now ? PREVIOUS_BONUS : 0);
      const cost = (overlap(occupied) + DOT_COST * (overlap(dots) + area - commonArea([0, 0, ...picture], box))) / area + bias;
      return { spot, left, top, box, cost };
    }));
    const best = spots.reduce((a, b) => (b.cost < a.cost ? b : a));
    occupied.push(best.box);
    return best;
  });
}
