// Diagram of the four tyres from above: load as a circle, horizontal force as an arrow, use of friction as colour.
import { svg, whole, write } from "../common/dom.js";

/** Half the width of the drawing, radius of the circle of the mean load, and distance of axles, in units of the drawing. */
const [HALF_SIDE, MEAN_LOAD_RADIUS, AXLE_DISTANCE] = [50, 13, 48];
/** Positions by the last letters of the name of a wheel, other wheels in pairs from the front; forward is up. */
const PLACES = { FL: [-26, -29], FR: [26, -29], RL: [-26, 19], RR: [26, 19] };
const pair = (/** @type {number} */ k) => [k % 2 ? 26 : -26, -29 + AXLE_DISTANCE * Math.floor(k / 2)];
/** Number of wheels up to which the words beside them are large enough to be read. */
const MAX_WORDED = 8;
/** Colours by the use of friction, 0 to 1. @type {[number, number[]][]} */
const COLOURS = [[0, [64, 150, 90]], [0.5, [110, 190, 90]], [0.8, [245, 190, 60]], [1, [232, 60, 45]]]; // prettier-ignore

/** Colour where the friction is not known. */
const UNKNOWN_COLOUR = "#9aa4ad";

/** Colour of a share of the friction. @param {number} use */
export function useColour(use) {
  const x = Math.max(0, Math.min(1, Number.isFinite(use) ? use : 0));
  const k = COLOURS.findIndex(([end]) => end >= x);
  const [from, a] = COLOURS[Math.max(0, k - 1)];
  const [to, b] = COLOURS[k];
  const s = to > from ? (x - from) / (to - from) : 0;
  return `rgb(${a.map((part, i) => Math.round(part + s * (b[i] - part))).join(",")})`;
}

/** Names of the wheels of an FMU, which has outputs `<wheel>.Fz`. @param {Iterable<string>} names */
export function wheelsOf(names) {
  return [...names].map((name) => /^(.*)\.Fz$/.exec(name)?.[1]).filter(Boolean);
}

/** Diagram of the forces of tyres on the car. */
export class Tyres {
  /**
   * @param {string[]} wheels their names
   * @param {(at: number[], wheel: string) => number} friction largest force over the load of a wheel at a point
   */
  constructor(wheels, friction) {
    this._friction = friction;
    this._mean = 0; // smoothed mean load of a wheel, N
    const ends = new Set(wheels.map((name) => name.slice(-2)));
    const known = ends.size === wheels.length && [...ends].every((end) => end in PLACES);
    this._items = wheels.map((name, k) => {
      const [x, y] = known ? PLACES[name.slice(-2)] : pair(k);
      const circle = svg("circle", { cx: x, cy: y, r: 0, "fill-opacity": 0.85, stroke: "#fff", "stroke-width": 0.8 });
      const arrow = svg("path", { stroke: "#fff", "stroke-width": 2.2, fill: "none", "stroke-linecap": "round", "stroke-linejoin": "round" });
      const ahead = `M${x - 4} ${y - MEAN_LOAD_RADIUS}v${2 * MEAN_LOAD_RADIUS}M${x + 4} ${y - MEAN_LOAD_RADIUS}v${2 * MEAN_LOAD_RADIUS}`;
      const tyre = svg("path", { d: ahead, stroke: "#fff6", "stroke-width": 1 });
      const words = [0, 7].map((down) => svg("text", { x, y: y + MEAN_LOAD_RADIUS + 7 + down, "text-anchor": "middle", "font-size": 7, fill: "#fff", stroke: "#0d1318", "stroke-width": 1.6, "paint-order": "stroke" }));
      return { name, x, y, circle, arrow, tyre, words, use: 0 };
    });
    const title = svg("title");
    title.textContent = "tyres: size is load in kN, arrow is force in the road's plane, colour is use of friction (grey: not known), below is slip";
    const drawn = this._items.flatMap(({ tyre, circle, arrow, words }) => [tyre, circle, arrow, ...(wheels.length > MAX_WORDED ? [] : words)]);
    const height = 2 * HALF_SIDE + AXLE_DISTANCE * Math.max(0, Math.ceil(wheels.length / 2) - 2);
    this.element = svg("svg", { viewBox: `${-HALF_SIDE} ${-HALF_SIDE} ${2 * HALF_SIDE} ${height}`, class: "a3-tyres", "data-a3": "tyres" }, title, ...drawn);
    this.element.style.display = wheels.length ? "" : "none";
  }

  /** Used share of friction by wheel. @returns {Object<string, number>} */
  get uses() {
    return Object.fromEntries(this._items.map(({ name, use }) => [name, use]));
  }

  /** @param {(name: string) => number} lookup */
  show(lookup) {
    const loads = this._items.map(({ name }) => Math.max(0, lookup(`${name}.Fz`) || 0));
    const mean = loads.reduce((sum, load) => sum + load, 0) / (loads.length || 1);
    if (mean > 0) this._mean = this._mean ? this._mean + 0.02 * (mean - this._mean) : mean;
    this._items.forEach((item, k) => this._draw(item, loads[k], lookup));
  }

  _draw(item, load, lookup) {
    const { name, x, y, circle, arrow, words } = item;
    const [fx, fy] = [lookup(`${name}.Fx`) || 0, lookup(`${name}.Fy`) || 0];
    const size = Math.hypot(fx, fy);
    const at = ["x", "y", "z"].map((axis) => lookup(`${name}.contact_${axis}`));
    const most = load * this._friction(at, name);
    item.use = most > 0 ? size / most : 0;
    const ratio = this._mean > 0 ? load / this._mean : 0;
    circle.setAttribute("r", (MEAN_LOAD_RADIUS * Math.sqrt(Math.min(ratio, 3))).toFixed(1));
    circle.setAttribute("fill", Number.isFinite(most) ? useColour(item.use) : UNKNOWN_COLOUR);
    const slip = lookup(`${name}.slip`);
    write(words[0], `${(load / 1e3).toFixed(1)} kN`);
    write(words[1], Number.isFinite(slip) ? `${whole(100 * slip)} %` : "");
    const scale = this._mean > 0 ? (1.6 * MEAN_LOAD_RADIUS) / this._mean : 0;
    const [dx, dy] = turned([-fy * scale, -fx * scale], lookup(`${name}.steer`) || 0);
    arrow.setAttribute("d", Math.hypot(dx, dy) < 1.5 ? "" : arrowPath(x, y, dx, dy));
  }
}

/** Vector in axes of the car from that in axes of a wheel steered to the left; y is down on the screen. */
function turned([x, y], steer) {
  const [c, s] = [Math.cos(steer), Math.sin(steer)];
  return [c * x + s * y, -s * x + c * y];
}

function arrowPath(x, y, dx, dy) {
  const size = Math.min(Math.hypot(dx, dy), 22);
  const [ux, uy] = [dx, dy].map((d) => d / Math.hypot(dx, dy));
  const [ex, ey] = [x + ux * size, y + uy * size];
  const head = Math.min(4, 0.5 * size);
  const wing = (side) => `M${f(ex)} ${f(ey)}L${f(ex - head * (ux + side * 0.7 * uy))} ${f(ey - head * (uy - side * 0.7 * ux))}`;
  return `M${x} ${y}L${f(ex)} ${f(ey)}${wing(1)}${wing(-1)}`;
}

const f = (number) => number.toFixed(1);
