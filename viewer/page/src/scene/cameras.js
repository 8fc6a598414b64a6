// The cameras of a scene: their positions, and how they follow the car or another body.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { across, add, cross, dot, perpendicular, rotate, scale, subtract, unit } from "./math.js";
import { TrailingDirection } from "./trailing_direction.js";

/** Positions of cameras and points at which they look, in sizes of the followed body: ahead, to the left, up. */
const VIEWS = { chase: [[-1.6, 0, 0.42], [0.6, 0, 0.06]], side: [[0, -2.1, 0.14], [0, 0, 0]], top: [[0, 0, 4], [0, 0, 0]] };
/** The same of the camera at a wheel, from its centre, for one at the front left. */
const WHEEL_VIEW = [[0.34, 0.2, 0.04], [0, -0.03, 0]];
/** Directions of the free camera at the start, ahead, to the left and up, and of the fixed one from the path, to the right and up. */
const [FREE_DIRECTION, FIXED_DIRECTION] = [[0.78, -1, 0.34], [0.94, 0.34]];
/** Position of the eyes of the driver behind and above the centre of the steering wheel, and of the point at which they look from them, m. */
const [EYE_POSITION, EYE_TARGET] = [[-0.48, 0.24], [10, -0.9]];
/** Least distance of the drawn from a camera and least and usual largest one, in sizes of the drawing; least largest one, m. */
const [NEAR, FAR, MIN_FAR] = [4e-3, 400, 3000];
/** Least and largest angle of view of a trackside camera, degrees, and half the width that it shows, in sizes of the body. */
const [NARROWEST, WIDEST, TRACKSIDE_WIDTH] = [6, 60, 0.7];
/** Least height of the chase camera above the ground, as a share of the size of the drawing. */
const CLEARANCE = 0.14;
const VIEW_ANGLES = { orbit: 34, chase: 42, driver: 66, wheel: 40, side: 30, top: 40, fixed: 40, trackside: 30 };
/** Least width of the followed body in the picture of the fixed camera, as a share of its width. */
const MIN_SHARE = 0.1;
/** Largest angle of the followed body from the middle of that picture, as a share of the angle to its upper edge. */
const MAX_ANGLE_SHARE = 0.5;
/** Half the size of the longest path with a fixed camera, as a share of the largest drawn distance. */
const MAX_PATH = 0.3;
/** Distance between trackside cameras, and from the path, relative to the size of the followed body. */
const [CAMERA_SPACING, PATH_DISTANCE] = [10, 3];
/** Turn, rad, and shift, pixels, of the free camera by a key, and the factor of its distance. */
const [KEY_TURN, KEY_SHIFT, KEY_ZOOM] = [Math.PI / 36, 40, 0.9];

/** Vector of components along three axes. @param {number[][]} axes @param {number[]} components */
const along = (axes, components) => axes.map((axis, k) => scale(axis, components[k])).reduce(add);

/** The cameras of a view, with positions relative to the origin of the picture. */
export class Cameras {
  /** @param {Data} view the SceneView @param {HTMLElement} element receives mouse and touch events */
  constructor(view, element) {
    this.view = view;
    const { extent, up, scene } = view;
    const [near, far] = [NEAR * extent, Math.max(FAR * extent, MIN_FAR)];
    this.rig = new THREE.PerspectiveCamera(VIEW_ANGLES.orbit, 1, near, far);
    this.free = scene.planar ? new THREE.OrthographicCamera(-1, 1, 1, -1, -far, far) : new THREE.PerspectiveCamera(VIEW_ANGLES.orbit, 1, near, far);
    this.free.up.fromArray(up);
    const shapes = scene.shapes ?? [];
    this.wheels = [...new Set(shapes.filter(({ kind }) => kind === "wheel").map(({ frame }) => frame))];
    this.seat = shapes.find(({ kind }) => kind === "steering_wheel");
    this.names = scene.planar ? ["orbit"] : this._names(scene.focus);
    this.aspect = 1;
    this.trailing = new TrailingDirection(view.options.trail ?? 0);
    this.home();
    this.controls = new OrbitControls(this.free, element);
    this.controls.enableDamping = false;
    Object.assign(this.controls, { minDistance: 0.05 * extent, maxDistance: 60 * extent, minZoom: 0.02, maxZoom: 50 });
    if (scene.planar) {
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    } else {
      this.controls.maxPolarAngle = 0.497 * Math.PI;
    }
    this.controls.addEventListener("start", () => (this.moved = true));
    this.current = this.free;
    this.name = "orbit";
  }

  /** Size of the followed body, m. */
  get extent() {
    return Math.min(this.view.extent, 2 * this.view.radius);
  }

  _names(focus) {
    const wheels = this.wheels.length <= 6 ? this.wheels.map((frame) => this._wheelName(frame)) : [];
    return ["orbit", ...(focus ? ["chase"] : []), ...(focus && this.seat ? ["driver"] : []), ...(focus ? wheels : []), "side", "top"];
  }

  /**
   * Adds fixed cameras: one that shows the whole path, and several beside it.
   * @param {number[][]} path earth positions of the followed body, m
   */
  stand(path) {
    const { up } = this.view;
    const { extent } = this;
    const [low, high] = [Math.min, Math.max].map((most) => [0, 1, 2].map((k) => path.reduce((a, point) => most(a, point[k]), path[0][k])));
    const rightOf = (from, to) => unit(cross(subtract(to, from), up)) ?? across(up);
    const right = rightOf(path[0], path[path.length - 1]);
    const centre = scale(add(low, high), 0.5);
    const reach = Math.hypot(...subtract(high, low)) / 2 + extent;
    this.fixed = { centre, reach, path, extent, from: unit(add(scale(right, FIXED_DIRECTION[0]), scale(up, FIXED_DIRECTION[1]))) };
    this.posts = [];
    let last = null;
    for (const point of path) {
      if (last !== null && Math.hypot(...subtract(point, last)) < CAMERA_SPACING * extent) continue;
      const aside = (this.posts.length % 2 === 0 ? 1 : -1) * PATH_DISTANCE * extent;
      this.posts.push(add(point, add(scale(last === null ? right : rightOf(last, point), aside), scale(up, 0.5 * extent))));
      last = point;
    }
    const watched = reach <= MAX_PATH * this.rig.far ? ["fixed"] : [];
    this.names = [...this.names, ...[...watched, "trackside"].filter((name) => !this.names.includes(name))];
  }

  /** Fixed camera: shows the whole path, or, if the followed body would be too small, the part around it. */
  _showPath() {
    const { up, origin } = this.view;
    if (this.fixed.aspect !== this.aspect) this._placeFixed();
    const { eye, half, whole, centre } = this.fixed;
    const from = subtract(eye, origin);
    this._angle((2 * half * 180) / Math.PI);
    const [ahead, toBody] = [unit(subtract(centre, eye)), unit(scale(from, -1))];
    const off = Math.acos(Math.min(1, dot(ahead, toBody)));
    const share = whole || off < MAX_ANGLE_SHARE * half ? 1 : (MAX_ANGLE_SHARE * half) / off;
    this._look(from, add(from, add(scale(ahead, share), scale(toBody, 1 - share))), up);
  }

  /** Position and half angle of view of the fixed camera for the aspect ratio of the picture. */
  _placeFixed() {
    const { centre, reach, from, path, extent } = this.fixed;
    const widest = Math.tan((VIEW_ANGLES.fixed / 2) * (Math.PI / 180));
    const eye = add(centre, scale(from, Math.min(reach / (widest * this.aspect), 0.7 * this.rig.far)));
    const farthest = path.reduce((most, point) => Math.max(most, Math.hypot(...subtract(point, eye))), 0);
    const narrow = extent / (2 * MIN_SHARE * farthest * this.aspect);
    Object.assign(this.fixed, { aspect: this.aspect, eye, half: Math.atan(Math.min(widest, narrow)), whole: narrow >= widest });
  }

  /** Trackside camera nearest to the followed body. */
  _showFromTrack() {
    const { extent, view: { up, origin } } = this; // prettier-ignore
    const from = this.posts.map((post) => subtract(post, origin)).reduce((a, b) => (Math.hypot(...a) <= Math.hypot(...b) ? a : b));
    const angle = (2 * Math.atan((TRACKSIDE_WIDTH * extent) / Math.hypot(...from)) * 180) / Math.PI;
    this._angle(Math.min(WIDEST, Math.max(NARROWEST, angle)));
    this._look(from, [0, 0, 0], up);
  }

  _angle(degrees) {
    if (this.rig.fov === degrees) return;
    this.rig.fov = degrees;
    this.rig.updateProjectionMatrix();
  }

  _wheelName(frame) {
    return /^wheel/.test(frame) ? frame : `wheel ${frame}`;
  }

  /** Actions of keys on the free camera; false while another camera is chosen. */
  get acts() {
    const free = (/** @type {(event: KeyboardEvent) => void} */ move) => (/** @type {KeyboardEvent} */ event) => {
      if (!this.controls.enabled) return false;
      this.moved = true;
      move(event);
      return true;
    };
    const arrow = (aside, upward) => free(({ shiftKey }) => {
      const { controls } = this;
      if (shiftKey || !controls.enableRotate) controls.pan(-aside * KEY_SHIFT, upward * KEY_SHIFT);
      else if (aside) controls.rotateLeft(-aside * KEY_TURN);
      else controls.rotateUp(upward * KEY_TURN);
    });
    return {
      ...{ ArrowLeft: arrow(-1, 0), ArrowRight: arrow(1, 0), ArrowUp: arrow(0, 1), ArrowDown: arrow(0, -1) },
      "+": free(() => this.controls.dollyIn(KEY_ZOOM)),
      "-": free(() => this.controls.dollyOut(KEY_ZOOM)),
    };
  }

  /** Moves the free camera to its initial position, unless the user has moved it. */
  home() {
    if (this.moved) return;
    const { extent, scene } = this.view;
    if (scene.planar) {
      this.free.position.set(0, 0, extent);
    } else {
      const from = unit(along(this._axes(), FREE_DIRECTION));
      const half = (VIEW_ANGLES.orbit / 2) * (Math.PI / 180);
      this.free.position.fromArray(scale(from, (0.98 * this.view.radius) / Math.sin(half * Math.min(1, this.aspect))));
    }
    this.free.lookAt(0, 0, 0);
  }

  /** Unit vectors of the followed body: horizontal forward and to the left, and up. */
  _axes() {
    const { up, scene, parts } = this.view;
    const { rotation, shown } = parts.frames.pose(scene.focus || "ground");
    const x = shown ? rotate(rotation, [1, 0, 0]) : [1, 0, 0];
    const forward = perpendicular(x, up) ?? across(up);
    return [forward, cross(up, forward), up];
  }

  /** Chooses a camera. @param {string} name */
  choose(name) {
    if (!this.names.includes(name)) {
      throw new Error(`There is no camera '${name}'; there are ${this.names.join(", ")}.`);
    }
    this.name = name;
    this.current = name === "orbit" ? this.free : this.rig;
    this.controls.enabled = name === "orbit";
    this.view.parts.materials.setCameraInside(name === "driver");
    this._angle(VIEW_ANGLES[name] ?? VIEW_ANGLES.wheel);
    this.follow();
  }

  /** Moves the camera with the followed body. */
  follow() {
    if (this.name === "orbit") return;
    if (this.name in VIEWS) this._showBody();
    else if (this.name === "driver") this._showFromDriver();
    else if (this.name === "fixed") this._showPath();
    else if (this.name === "trackside") this._showFromTrack();
    else this._showWheel(this.wheels.find((frame) => this._wheelName(frame) === this.name));
  }

  /** Camera at a distance from the followed body: behind it and above the ground, beside it, above it. */
  _showBody() {
    const { extent, name, view: { up, origin, look } } = this; // prettier-ignore
    const axes = this._axes();
    if (name === "chase") axes[0] = this.trailing.along(axes[0], up);
    const [from, at] = VIEWS[name].map((place) => scale(along(axes, place), extent));
    if (name === "chase" && look?.height && up[2] > 0.9) {
      const [x, y, z] = add(origin, from);
      from[2] += Math.max(0, look.height(x, y) + CLEARANCE * extent - z);
    }
    const north = Math.abs(up[1]) > 0.7 ? [0, 0, -1] : [0, 1, 0];
    this._look(from, at, name === "top" ? north : up);
  }

  _look(from, at, up) {
    this.rig.up.fromArray(up);
    this.rig.position.fromArray(from);
    this.rig.lookAt(new THREE.Vector3().fromArray(at));
  }

  /** Camera at the eyes of the driver, fixed in the body. */
  _showFromDriver() {
    const { parts, scene, origin } = this.view;
    const { rotation } = parts.frames.pose(scene.focus);
    const wheel = parts.frames.point(this.seat.frame, this.seat.at ?? [0, 0, 0]);
    if (wheel === null) return;
    const axes = [0, 1, 2].map((k) => [rotation[k], rotation[3 + k], rotation[6 + k]]);
    const beside = (from, place) => add(from, along(axes, [place[0], 0, place[1]]));
    const eye = beside(subtract(wheel, origin), EYE_POSITION);
    this._look(eye, beside(eye, EYE_TARGET), axes[2]);
  }

  /** Whether the eyes of the driver are in a ghost, which would tint the whole picture. @param {import("./parts.js").Parts} ghost */
  within(ghost) {
    if (this.name !== "driver") return false;
    const { position, shown } = ghost.frames.pose(ghost.scene.focus || "ground");
    const from = subtract(subtract(position, this.view.origin), this.rig.position.toArray());
    return shown && Math.hypot(...from) < this.extent / 2;
  }

  /** Camera at a wheel and its suspension, from the front and outside. */
  _showWheel(frame) {
    const { parts, up, origin } = this.view;
    const place = parts.frames.point(frame, [0, 0, 0]);
    if (place === null) return;
    const at = subtract(place, origin);
    const outward = this._axes().map((axis) => (dot(at, axis) >= 0 || axis === up ? axis : scale(axis, -1)));
    const [from, target] = WHEEL_VIEW.map((offset) => add(at, scale(along(outward, offset), this.extent)));
    this._look(from, target, up);
  }

  resize(width, height) {
    this.aspect = this.rig.aspect = width / height;
    const { lift = 0 } = this.view.options;
    for (const camera of [this.rig, this.free]) camera.setViewOffset(width, height, 0, lift * height, width, height);
    this.rig.updateProjectionMatrix();
    if (this.free instanceof THREE.PerspectiveCamera) {
      this.free.aspect = width / height;
    } else {
      const [wide, high] = this.view.reach;
      const y = 0.62 * Math.max(high, wide / this.aspect);
      const x = y * this.aspect;
      Object.assign(this.free, { left: -x, right: x, top: y, bottom: -y });
    }
    this.free.updateProjectionMatrix();
    this.home();
  }

  dispose() {
    this.controls.dispose();
  }
}
