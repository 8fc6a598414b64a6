// Maps of the world and of the surroundings of the car, with places and the car.
import { el } from "../common/dom.js";
import { addKeys } from "../common/keys.js";
import { besides } from "../common/labels.js";

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
/** Logarithm of the zoom for each pixel that a wheel scrolls. */
const WHEEL_ZOOM = 0.0015;
/** Limits of the zoom; a map of the whole world is not drawn smaller than 1. */
const [MIN_ZOOM, MAX_ZOOM] = [0.2, 30];
/** Share of the free area that the whole world fills. */
const FILLED_SHARE = 0.95;
/** Radius of the mark of a place, pixels. */
const PLACE_RADIUS = 4;
/** Largest ratio of pixels of the device to those of the page with which maps are drawn. */
const MAX_PIXEL_RATIO = 2;
/** Corners of the arrow that is the car, pixels ahead and to its right. */
const ARROW = [[9, 0], [-7, 6], [-4, 0], [-7, -6]];

/** @typedef {import("./world_plan.js").WorldPlan} WorldPlan */

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
      this._zoom(Math.exp(-WHEEL_ZOOM * event.deltaY));
    };
    this._canvas.addEventListener("wheel", turned, { passive: false });
    if (go) this._canvas.addEventListener("click", (event) => this._click(event, go));
  }

  /** @param {{x: number, y: number, yaw: number}} car */
  show(car) {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    this._car = car;
    const ratio = Math.min(globalThis.devicePixelRatio || 1, MAX_PIXEL_RATIO);
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
    const scale = this.zoom * FILLED_SHARE * Math.min((right - left) / Math.max(1, x1 - x0), (bottom - top) / Math.max(1, y1 - y0));
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
      context.arc(x, y, PLACE_RADIUS, 0, 2 * Math.PI);
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
    ARROW.forEach(([px, py], k) => (k ? context.lineTo(px, py) : context.moveTo(px, py)));
    context.closePath();
    context.fill();
    context.stroke();
    context.restore();
  }

  /** @param {number} factor */
  _zoom(factor) {
    this.zoom = Math.max(this._whole ? 1 : MIN_ZOOM, Math.min(MAX_ZOOM, this.zoom * factor));
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
