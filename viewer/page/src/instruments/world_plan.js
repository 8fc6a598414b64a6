// What all maps of a world draw: ground, scenery and the path of the car.
import { Surfaces } from "./surfaces.js";
import { Trail } from "./trail.js";

const PAINTS = { white: "#f2f2ee", yellow: "#f0c84a", red: "#d8503f", blue: "#4a7fd8" };
const COLOURS = {
  background: "#3d4a36",
  road: "#5c6066",
  kerb: "#d9d6cc",
  bounds: "#e8eef4",
  trail: "#ffd23f",
  barrier: "#b9bdc2",
  building: "#8c8078",
  tree: "#2f5228",
  cone: "#ff7a2f",
  post: "#e8e8e8",
};
/** Half the side of the map of a road without end, and half the length of a kerb across it, m. */
const [ENDLESS, KERB_REACH] = [250, 1000];
/** Widths of the frame and of the trail, pixels. */
const [BOUNDS_WIDTH, TRAIL_WIDTH] = [1.5, 2];
/** Widths of paint without one of its own and of barriers, m, and least width of paint, pixels. */
const [PAINT_WIDTH, BARRIER_WIDTH, MIN_PAINT_WIDTH] = [0.15, 0.4, 0.8];
/** Radius of the crown of a tree over its height; radii of cones and posts, m; least radius that is drawn, pixels. */
const [CROWN, CONE_RADIUS, POST_RADIUS, MIN_RADIUS] = [0.3, 0.3, 0.2, 0.3];

/** The content of all maps of a world. */
export class WorldPlan {
  /** @param {Data} scene with roads and scenery @param {{name?: string, places?: Data[], bounds?: number[]}} world */
  constructor(scene, world = {}) {
    this.surfaces = new Surfaces(scene.roads);
    this.pictures = this.surfaces.pictures();
    this.scenery = scene.scenery ?? [];
    this.places = world.places ?? [];
    this._bounded = Boolean(world.bounds);
    this.bounds = world.bounds ?? this.pictures[0]?.box ?? [-ENDLESS, -ENDLESS, ENDLESS, ENDLESS];
    /** Colour beyond the pictures; a scene without any has one road without end. */
    this.colour = this.pictures.length ? COLOURS.background : COLOURS.road;
    this.kerbs = (scene.roads ?? []).filter((road) => road.kind === "profile");
    this.trail = new Trail();
  }

  /** Whether a position is in the bounds of the world, if it has any. @param {{x: number, y: number}} car */
  holds({ x, y }) {
    if (!this._bounded || !Number.isFinite(x + y)) return true;
    const [x0, y0, x1, y1] = this.bounds;
    return x >= x0 && x <= x1 && y >= y0 && y <= y1;
  }

  /** Draws the constant part. @param {CanvasRenderingContext2D} context in metres, x to the right, y up @param {number} pixel m */
  drawGround(context, pixel) {
    const [x0, y0, x1, y1] = this.bounds;
    for (const { image, box } of this.pictures) {
      context.save();
      if (this._bounded) {
        context.beginPath();
        context.rect(x0, y0, x1 - x0, y1 - y0); // without the outer halves of border cells
        context.clip();
      }
      context.translate(box[0], box[3]);
      context.scale((box[2] - box[0]) / image.width, -(box[3] - box[1]) / image.height);
      context.drawImage(image, 0, 0);
      context.restore();
    }
    for (const thing of this.scenery) drawThing(context, thing, pixel);
    for (const { origin = [0, 0, 0], direction = [1, 0, 0], stations } of this.kerbs) {
      for (const s of stations) {
        const [x, y] = [origin[0] + s * direction[0], origin[1] + s * direction[1]];
        stroke(context, [[x - KERB_REACH * direction[1], y + KERB_REACH * direction[0]], [x + KERB_REACH * direction[1], y - KERB_REACH * direction[0]]], COLOURS.kerb, pixel); // prettier-ignore
      }
    }
    if (!this._bounded && !this.pictures.length) return;
    context.strokeStyle = COLOURS.bounds;
    context.lineWidth = BOUNDS_WIDTH * pixel;
    context.strokeRect(x0, y0, x1 - x0, y1 - y0);
  }

  /** Draws the path of the car. @param {CanvasRenderingContext2D} context as for the ground @param {number} pixel m */
  drawTrail(context, pixel) {
    let stretch = [];
    for (const point of [...this.trail.points, null]) {
      if (point) stretch.push(point);
      else {
        stroke(context, stretch, COLOURS.trail, TRAIL_WIDTH * pixel);
        stretch = [];
      }
    }
  }
}

function stroke(context, points, colour, width, dash = []) {
  if (points.length < 2) return;
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dash);
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
  context.setLineDash([]);
}

function drawThing(context, { kind, at, points, width, colour, dash, height = 1, size, yaw = 0 }, pixel) {
  if (kind === "line") stroke(context, points, PAINTS[colour] ?? colour ?? PAINTS.white, Math.max(width ?? PAINT_WIDTH, MIN_PAINT_WIDTH * pixel), dash);
  else if (kind === "barrier") stroke(context, points, COLOURS.barrier, Math.max(BARRIER_WIDTH, pixel));
  else if (kind === "building" && size) {
    context.save();
    context.translate(at[0], at[1]);
    context.rotate(yaw);
    context.fillStyle = COLOURS.building;
    context.fillRect(-size[0] / 2, -size[1] / 2, size[0], size[1]);
    context.restore();
  } else if (at) {
    const radius = { tree: CROWN * height, cone: Math.max(CONE_RADIUS, pixel), post: POST_RADIUS }[kind]; // cones mark what is to be driven
    if (!radius || radius < MIN_RADIUS * pixel) return;
    context.fillStyle = COLOURS[kind];
    context.beginPath();
    context.arc(at[0], at[1], radius, 0, 2 * Math.PI);
    context.fill();
  }
}
