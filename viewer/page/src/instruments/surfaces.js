// Surfaces of a world: friction at a point, and pictures for the map.
import { el } from "../common/dom.js";
import { floats } from "../bytes.js";
import { SurfaceRaster, gripOf, nearest, slickness } from "../looks/heights.js";

/** Colours of surfaces on the map. */
const COLOURS = {
  asphalt: [92, 96, 102], concrete: [150, 150, 146], grass: [86, 112, 66], gravel: [140, 124, 98],
  dirt: [120, 98, 74], wet: [58, 84, 116], ice: [176, 208, 226], paint: [214, 214, 210],
}; // prettier-ignore
const OTHER_COLOUR = [128, 118, 128];
/** Friction of a road without a value, for a car without that parameter. */
const DEFAULT_FRICTION = 1.0;

/** The surfaces of the roads of a scene. */
export class Surfaces {
  /** @param {Data[]} roads of a scene */
  constructor(roads = []) {
    this.grids = roads.map(gridOf).filter(Boolean);
  }

  /** Coefficient of friction at a point; NaN if the roads have none. @param {number} x @param {number} y */
  friction(x, y) {
    const { grid, frictions } = this.grids.find((one) => one.frictions) ?? {};
    return frictions && Number.isFinite(x + y) ? frictions(nearest(grid, x, y)) : NaN;
  }

  /**
   * Pictures of the ground from above: x to the right, y up.
   * @returns {{image: HTMLCanvasElement, box: number[]}[]} with the covered rectangle: x0, y0, x1, y1, m
   */
  pictures() {
    return this.grids.map(({ grid, colour }) => ({ image: imageOf(grid, colour), box: boxOf(grid) }));
  }
}

/**
 * Largest longitudinal force of a tyre over its load on the road at a point; NaN if the car has no value.
 * @param {Surfaces} surfaces @param {(name: string) => unknown} fixed constants and parameters of the car
 * @param {number[]} at x and y @param {string} wheel name that ends as in wheel_FL
 */
export function frictionOf(surfaces, fixed, [x, y], wheel) {
  const axle = wheel.at(-2) === "R" ? "rear" : "front";
  const number = (/** @type {string} */ name, /** @type {number} */ other) => Number(fixed(name) ?? other);
  const local = surfaces.friction(x, y);
  const road = Number.isFinite(local) ? local : number("road.friction", DEFAULT_FRICTION);
  return road * number("road.friction_factor", 1) * number(`vehicle.tyre_friction_${axle}`, NaN) * number(`${axle}.tyre.grip`, 1);
}

function gridOf(road) {
  if (road.kind === "terrain" && road.surface) {
    const { names, classes, ...grid } = new SurfaceRaster(road.surface);
    const colours = names.map((name) => COLOURS[name] ?? OTHER_COLOUR);
    const frictions = (index) => road.surface.frictions[classes[index]];
    return { grid, frictions, colour: (index) => colours[classes[index]] ?? OTHER_COLOUR };
  }
  if (road.kind !== "grid") return null;
  const heights = floats(road.heights);
  const given = road.frictions === undefined ? null : floats(road.frictions);
  const [low, high] = heights.reduce(([a, b], h) => [Math.min(a, h), Math.max(b, h)], [Infinity, -Infinity]);
  const base = COLOURS.asphalt;
  const colour = (index) => {
    const light = high > low ? 0.75 + (0.6 * (heights[index] - low)) / (high - low) : 1;
    const [film, ice] = slickness(given ? given[index] * (road.friction_factor ?? 1) : gripOf(road));
    const mixed = (from, to, share) => from.map((part, k) => part + share * (to[k] - part));
    return mixed(mixed(base, COLOURS.wet, film), COLOURS.ice, ice).map((part) => light * part);
  };
  return { grid: road, frictions: null, colour };
}

function boxOf({ origin, spacing, shape }) {
  const half = spacing.map((d) => d / 2);
  return [origin[0] - half[0], origin[1] - half[1], origin[0] + (shape[0] - 1) * spacing[0] + half[0], origin[1] + (shape[1] - 1) * spacing[1] + half[1]];
}

/** Largest number of pixels of a side of a picture of the ground. */
const MAX_PIXELS = 1400;

function imageOf(grid, colour) {
  const [n, m] = grid.shape;
  const every = Math.max(1, Math.ceil(Math.max(n, m) / MAX_PIXELS));
  const image = el("canvas");
  [image.width, image.height] = [Math.ceil(n / every), Math.ceil(m / every)];
  const context = image.getContext("2d");
  const pixels = context.createImageData(image.width, image.height);
  for (let a = 0; a < image.width; a++) {
    for (let b = 0; b < image.height; b++) {
      const [red, green, blue] = colour(a * every * m + b * every);
      pixels.data.set([red, green, blue, 255], 4 * ((image.height - 1 - b) * image.width + a));
    }
  }
  context.putImageData(pixels, 0, 0);
  return image;
}
