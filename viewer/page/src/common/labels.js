// Layout of labels beside points of a picture; pure numbers.

/** Words stand higher by so many of their heights, tried in this order, and so many pixels beside their dot. */
const [HIGHER, GAP] = [[0, 1, -1, 2, -2, 3, -3], 8];
/** Half the side of a dot, pixels. */
const DOT = 5;
/** Words over a dot or outside of the picture are so much worse than words over each other. */
const DEAR = 10;
/** A spot is worse than the one before it by so much of its area, and where words are it is better by so much. */
const [LATER, STAYS] = [0.001, 0.1];

/** The area that two boxes share. @param {number[]} one left, top, right, bottom @param {number[]} other */
const shared = (one, other) => [0, 1].map((k) => Math.max(0, Math.min(one[k + 2], other[k + 2]) - Math.max(one[k], other[k]))).reduce((a, b) => a * b);

/**
 * Where words hide least of each other, of dots and of what stands over the picture, one after the other.
 * @param {{at: number[], size: number[], above?: number[], sides?: number[], spot?: string}[]} labels
 *   at: the dot, pixels; size: width and height; above: how far their top is above the dot, in their heights and in
 *   pixels; sides: right of it (1), left (-1), across it (0), best first; spot: where they are, as of the last time
 * @param {number[]} picture width and height
 * @param {number[][]} [over] boxes that stand over it
 * @returns {{spot: string, left: number, top: number}[]}
 */
export function besides(labels, picture, over = []) {
  const dots = labels.map(({ at: [x, y] }) => [x - DOT, y - DOT, x + DOT, y + DOT]);
  const taken = [...over];
  return labels.map(({ at: [x, y], size: [width, height], above: [share, more] = [0.5, 0], sides = [1, -1, 0], spot: now }) => {
    const area = width * height || 1; // of none where nothing is shown
    const spots = HIGHER.flatMap((higher) => sides.map((side, k) => {
      const beside = x + side * GAP - ((1 - side) / 2) * width;
      const [left, top] = [Math.max(0, Math.min(beside, picture[0] - width)), y - (share + higher) * height - more];
      const box = [left, top, left + width, top + height];
      const hidden = (/** @type {number[][]} */ boxes) => boxes.reduce((sum, one) => sum + shared(one, box), 0);
      const spot = `${side} ${higher}`;
      const later = LATER * (sides.length * HIGHER.indexOf(higher) + k) - (spot === now ? STAYS : 0);
      const cost = (hidden(taken) + DEAR * (hidden(dots) + area - shared([0, 0, ...picture], box))) / area + later;
      return { spot, left, top, box, cost };
    }));
    const best = spots.reduce((a, b) => (b.cost < a.cost ? b : a));
    taken.push(best.box);
    return best;
  });
}
