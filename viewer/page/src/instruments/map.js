// The map of the world: ground, scenery and places, the car and its path.
import { el } from "../common/dom.js";
import { addKeys } from "../common/keys.js";
import { besides } from "../common/labels.js";
import { Surfaces } from "./surfaces.js";

/** Distance of points of the trail, m, and their largest number. */
const [SPACING, MAX_POINTS] = [1.5, 4000];
/** Distance of the car from the border of the small map, m. */
const MAP_DISTANCE = 110;
/** Radius of the clickable area of a place, pixels. */
const CLICK_RADIUS = 18;
/** Margin of the drawn ground beyond each side of a map, as a share of that side. */
const MARGIN = 0.5;
/** Height of a line of text, pixels. */
const LINE_HEIGHT = 14;
/** Factor of the zoom by a key. */
const KEY_ZOOM = 1.25;
const [BACKGROUND, ROAD] = ["#3d4a36", "#5c6066"];
const PAINTS = { white: "#f2f2ee", yellow: "#f0c84a", red: "#d8503f", blue: "#4a7fd8" };

/** The thinned path of the car, interrupted where it was moved to another position. */
export class Trail {
  constructor() {
    this.points = []; // [x, y], or null for an interruption
    /** @type {{time: number, epoch: number} | undefined} */
    this.now = undefined;
  }

  /** @param {number} x @param {number} y */
  add(x, y) {
    const last = this.points[this.points.length - 1];
    if (!Number.isFinite(x + y) || (last && Math.hypot(x - last[0], y - last[1]) < SPACING)) return;
    this.points.push([x, y]);
    if (this.points.length > MAX_POINTS) this.points.splice(0, MAX_POINTS / 10);
  }

  /**
   * Sets the time of the next point; the trail is interrupted if time goes back, jumps, or the epoch changes.
   * @param {number} time s @param {number} epoch @param {number} longest s
   */
  at(time, epoch, longest) {
    const { time: before, epoch: last } = this.now ?? { time, epoch };
    if (time < before || time - before > longest || epoch !== last) this.lift();
    this.now = { time, epoch };
  }

  /** Interrupts the trail. */
  lift() {
    if (this.points.length && this.points[this.points.length - 1]) this.points.push(null);
  }
}

/** The content of all maps of a world. */
export class WorldPlan {
  /** @param {Data} scene with roads and scenery @param {{name?: string, places?: Data[], bounds?: number[]}} world */
  constructor(scene, world = {}) {
    this.surfaces = new Surfaces(scene.roads);
    this.pictures = this.surfaces.pictures();
    this.scenery = scene.scenery ?? [];
    this.places = world.places ?? [];
    this._bounded = Boolean(world.bounds);
    this.bounds = world.bounds ?? this.pictures[0]?.box ?? [-250, -250, 250, 250];
    /** Colour beyond the pictures; a scene without any has one road without end. */
    this.colour = this.pictures.length ? BACKGROUND : ROAD;
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
        stroke(context, [[x - 1e3 * direction[1], y + 1e3 * direction[0]], [x + 1e3 * direction[1], y - 1e3 * direction[0]]], "#d9d6cc", pixel); // prettier-ignore
      }
    }
    if (!this._bounded && !this.pictures.length) return;
    context.strokeStyle = "#e8eef4";
    context.lineWidth = 1.5 * pixel;
    context.strokeRect(x0, y0, x1 - x0, y1 - y0);
  }

  /** Draws the path of the car. @param {CanvasRenderingContext2D} context as for the ground @param {number} pixel m */
  drawTrail(context, pixel) {
    let stretch = [];
    for (const point of [...this.trail.points, null]) {
      if (point) stretch.push(point);
      else {
        stroke(context, stretch, "#ffd23f", 2 * pixel);
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
  if (kind === "line") stroke(context, points, PAINTS[colour] ?? colour ?? PAINTS.white, Math.max(width ?? 0.15, 0.8 * pixel), dash);
  else if (kind === "barrier") stroke(context, points, "#b9bdc2", Math.max(0.4, pixel));
  else if (kind === "building" && size) {
    context.save();
    context.translate(at[0], at[1]);
    context.rotate(yaw);
    context.fillStyle = "#8c8078";
    context.fillRect(-size[0] / 2, -size[1] / 2, size[0], size[1]);
    context.restore();
  } else if (at) {
    const radius = { tree: 0.3 * height, cone: Math.max(0.3, pixel), post: 0.2 }[kind]; // cones mark what is to be driven
    if (!radius || radius < 0.3 * pixel) return;
    context.fillStyle = { tree: "#2f5228", cone: "#ff7a2f", post: "#e8e8e8" }[kind];
    context.beginPath();
    context.arc(at[0], at[1], radius, 0, 2 * Math.PI);
    context.fill();
  }
}

/** The ground of a map with a margin, redrawn only if the map moves beyond it. */
class Ground {
  /** @param {WorldPlan} plan */
  constructor(plan) {
    this.plan = plan;
    this.canvas = el("canvas");
    /** Pixels per metre and centre of the drawn ground; 0: not drawn yet. */
    this.scale = this.x = this.y = 0;
  }

  /**
   * @param {CanvasRenderingContext2D} context of the map, in its pixels
   * @param {{scale: number, x: number, y: number, pixel: number}} view pixels per metre, centre, and
   *   least width of lines, m.
   * @param {boolean} moves whether the centre follows the car
   */
  draw(context, view, moves) {
    const { width, height } = context.canvas;
    const [marginX, marginY] = [width, height].map((side) => (moves ? Math.round(MARGIN * side) : 0));
    const shift = () => [this.scale * (this.x - view.x), this.scale * (view.y - this.y)].map(Math.round);
    const fits = this.scale === view.scale && this.canvas.width === width + 2 * marginX && this.canvas.height === height + 2 * marginY;
    if (!fits || shift().some((pixels, k) => Math.abs(pixels) > [marginX, marginY][k])) this._redraw(view, width + 2 * marginX, height + 2 * marginY);
    const [right, down] = shift();
    context.drawImage(this.canvas, right - marginX, down - marginY);
  }

  _redraw({ scale, x, y, pixel }, w, h) {
    this.scale = scale;
    this.x = x;
    this.y = y;
    Object.assign(this.canvas, { width: w, height: h }); // clears the canvas
    const context = this.canvas.getContext("2d");
    context.fillStyle = this.plan.colour;
    context.fillRect(0, 0, w, h);
    context.setTransform(scale, 0, 0, -scale, w / 2 - scale * x, h / 2 + scale * y);
    this.plan.drawGround(context, pixel);
  }
}

/** A map of the whole world or of the surroundings of the car. */
export class WorldMap {
  /**
   * @param {WorldPlan} plan
   * @param {object} [options]
   * @param {boolean} [options.whole] of the whole world
   * @param {(place: Data) => void} [options.go] called with a clicked place
   * @param {() => number[]} [options.free] left, top, right and bottom of the free area for the world, pixels of the
   *   element; by default all of it.
   */
  constructor(plan, { whole = false, go, free } = {}) {
    this.plan = plan;
    this._whole = whole;
    this._free = free;
    this.zoom = 1;
    this._ground = new Ground(plan);
    this._canvas = el("canvas");
    addKeys(this._canvas, "map", { "+": () => this._zoom(KEY_ZOOM), "-": () => this._zoom(1 / KEY_ZOOM) });
    this.element = el(whole ? "div.a3-map" : "div.a3-inset", { data: whole ? "map" : "map inset" }, this._canvas);
    const turned = (event) => {
      event.preventDefault();
      this._zoom(Math.exp(-0.0015 * event.deltaY));
    };
    this._canvas.addEventListener("wheel", turned, { passive: false });
    if (go) this._canvas.addEventListener("click", (event) => this._click(event, go));
  }

  /** @param {{x: number, y: number, yaw: number}} car */
  show(car) {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    this._car = car;
    const ratio = Math.min(globalThis.devicePixelRatio || 1, 2);
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this._canvas.width !== w || this._canvas.height !== h) Object.assign(this._canvas, { width: w, height: h });
    const context = this._canvas.getContext("2d");
    const { scale, x, y } = this._view(width, height);
    context.setTransform(1, 0, 0, 1, 0, 0);
    this._ground.draw(context, { scale: ratio * scale, x, y, pixel: 1 / scale }, !this._whole || this.zoom > 1);
    context.setTransform(ratio * scale, 0, 0, -ratio * scale, w / 2 - ratio * scale * x, h / 2 + ratio * scale * y);
    this.plan.drawTrail(context, 1 / scale);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this._drawNames(context, width, height);
    this._drawCar(context, this.pixel([car.x, car.y]), car.yaw);
  }

  /** Position of a point of the earth in the element, pixels. @param {number[]} point */
  pixel([px, py]) {
    const { clientWidth: width, clientHeight: height } = this.element;
    const { scale, x, y } = this._view(width, height);
    return [width / 2 + scale * (px - x), height / 2 - scale * (py - y)];
  }

  _view(width, height) {
    const car = this._car ?? { x: 0, y: 0 };
    if (!this._whole) return { scale: (this.zoom * Math.min(width, height)) / (2 * MAP_DISTANCE), x: car.x, y: car.y };
    const [x0, y0, x1, y1] = this.plan.bounds;
    const [left, top, right, bottom] = this._free?.() ?? [0, 0, width, height];
    const scale = this.zoom * 0.95 * Math.min((right - left) / Math.max(1, x1 - x0), (bottom - top) / Math.max(1, y1 - y0));
    const middle = this.zoom <= 1 ? { x: (x0 + x1) / 2, y: (y0 + y1) / 2 } : car;
    return { scale, x: middle.x - (left + right - width) / 2 / scale, y: middle.y + (top + bottom - height) / 2 / scale };
  }

  _drawNames(context, width, height) {
    if (!this._whole) return;
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "middle";
    const labels = this.plan.places
      .map((place) => ({ words: place.name.replaceAll("_", " "), at: this.pixel([place.x, place.y]) }))
      .filter(({ at: [x, y] }) => x >= 0 && y >= 0 && x <= width && y <= height);
    const spots = besides(labels.map(({ words, at }) => ({ at, size: [context.measureText(words).width, LINE_HEIGHT] })), [width, height]);
    for (const [k, { words, at }] of labels.entries()) {
      const [[x, y], { left, top }] = [at, spots[k]];
      context.fillStyle = "#ffffff";
      context.beginPath();
      context.arc(x, y, 4, 0, 2 * Math.PI);
      context.fill();
      context.strokeStyle = "#10161c";
      context.lineWidth = 3;
      context.strokeText(words, left, top + LINE_HEIGHT / 2);
      context.fillText(words, left, top + LINE_HEIGHT / 2);
    }
  }

  /** @param {CanvasRenderingContext2D} context @param {number[]} place pixels @param {number} yaw rad */
  _drawCar(context, [x, y], yaw) {
    context.save();
    context.translate(x, y);
    context.rotate(-yaw);
    context.fillStyle = "#e5352b";
    context.strokeStyle = "#fff";
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(9, 0);
    context.lineTo(-7, 6);
    context.lineTo(-4, 0);
    context.lineTo(-7, -6);
    context.closePath();
    context.fill();
    context.stroke();
    context.restore();
  }

  /** @param {number} factor */
  _zoom(factor) {
    this.zoom = Math.max(this._whole ? 1 : 0.2, Math.min(30, this.zoom * factor));
    if (this._car) this.show(this._car);
  }

  _click(event, go) {
    const place = this.plan.places.find(({ x, y }) => {
      const [px, py] = this.pixel([x, y]);
      return Math.hypot(px - event.offsetX, py - event.offsetY) < CLICK_RADIUS;
    });
    if (place) go(place);
  }
}
