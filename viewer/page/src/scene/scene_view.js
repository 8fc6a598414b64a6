// Draws a scene in an element of a page.
import * as THREE from "three";
import { Cameras } from "./cameras.js";
import { add, dot, middle, rotate, subtract, transpose, unit } from "./math.js";
import { Legends, arrowLegend, stressLegend } from "./legends.js";
import { Marks } from "./marks.js";
import { Notes } from "./notes.js";
import { Parts } from "./parts.js";
import { wrongName } from "./plain_names.js";
import { makeRenderer } from "./renderer.js";
import { addKeys } from "../common/keys.js";
import { makeLook } from "../looks/index.js";

/** A picture of a scene, drawn relative to the focus so that positions are accurate at 100 km too. */
export class SceneView {
  /**
   * @param {HTMLElement} container an element with a size, which the picture fills
   * @param {Data} scene see viewer/scene.schema.json
   * @param {object} [options]
   * @param {string} [options.quality] of QUALITIES in looks/picture_quality.js; auto: by the measured drawing time
   * @param {boolean} [options.driven] pictures follow a simulation in real time: auto may choose a draft
   * @param {string} [options.camera] the first camera
   * @param {boolean} [options.words] legend of the grid, by default true
   * @param {number} [options.lift] upward shift of the picture as a share of its height
   * @param {number} [options.trail] time constant of the chase camera in turns, s; by default 0
   * @param {boolean} [options.keep] whether the canvas can be read after drawing
   * @param {(sentence: string) => void} [options.onMessage] receives each sentence on parts that are not drawn once
   */
  constructor(container, scene, options = {}) {
    this.container = container;
    this.scene = scene;
    this.options = options;
    this.lookup = null;
    /** Reason why nothing is drawn; empty if something is. */
    this.problem = "";
    if (getComputedStyle(container).position === "static") container.style.position = "relative";
    this.notes = new Notes(container, options.onMessage);
    const tell = (sentence) => this.notes.tell(sentence);
    this.legends = new Legends(this.notes.legend);
    this.parts = new Parts(scene, { tell });
    this.ghosts = [];
    this.up = unit(scene.up ?? [0, 0, 1]) ?? [0, 0, 1];
    this._measure();
    const wrong = wrongName(scene);
    if (wrong) {
      this._fail(wrong);
      return;
    }
    const { renderer, software, problem } = makeRenderer(container, { smooth: options.quality === "high" || scene.planar, keep: options.keep });
    if (problem !== undefined) {
      this._fail(problem);
      return;
    }
    this.renderer = renderer;
    this.software = software;
    this.world = new THREE.Scene();
    this.world.add(this.parts.group);
    this.cameras = new Cameras(this, renderer.domElement);
    this.marks = new Marks(this.notes.layer, this, renderer.domElement);
    this.look = makeLook(this);
    addKeys(renderer.domElement, `drawing of ${scene.name ?? "a scene"}`, { ...this.cameras.acts, Enter: () => this.marks.pickNext() });
    this._watchContext();
    this.camera(options.camera ?? this.cameras.names[0]);
    this.observer = new ResizeObserver(() => this._resized());
    this.observer.observe(container);
    this.resize();
    this.update(null);
  }

  /** Sentences on parts that are not drawn. @returns {string[]} */
  get messages() {
    return this.problem ? [this.problem, ...this.notes.said] : this.notes.said;
  }

  /** Names of the cameras. @returns {string[]} */
  get cameraNames() {
    return this.cameras?.names ?? [];
  }

  /**
   * Moves all parts to the values of a time.
   * @param {((name: string) => number | undefined) | null} lookup values of columns; null: the scene as drawn
   */
  update(lookup) {
    this.lookup = lookup;
    this.parts.update(lookup);
    const { position, rotation, shown } = this.parts.frames.pose(this.scene.focus || "ground");
    if (shown) this.origin = add(position, rotate(rotation, this.centre));
    this._updateLegends();
  }

  /**
   * Samples a run for constant scales of colours and arrows and a constant floor height.
   * @param {(i: number) => (name: string) => number | undefined} lookupAt values at the sampled times
   * @param {number} count number of times
   */
  scan(lookupAt, count) {
    const { parts } = this;
    const every = Math.max(1, Math.floor(count / 40));
    const grounded = (this.scene.roads ?? []).length > 0; // a road replaces the floor
    let [box, floor] = [null, Infinity];
    for (let i = 0; i < count; i++) {
      parts.update(lookupAt(i));
      if ((this.scene.focus && grounded) || (i % every !== 0 && i !== count - 1)) continue;
      const [low, high] = parts.bounds() ?? this.bounds;
      floor = Math.min(floor, this._lowest([low, high]));
      if (this.scene.focus) continue;
      box = box ? [low.map((a, k) => Math.min(a, box[0][k])), high.map((a, k) => Math.max(a, box[1][k]))] : [low, high];
    }
    if (box !== null) {
      this._fit(box);
      this.resize();
    }
    this.floor = Math.min(this.floor, floor);
    this.update(count > 0 ? lookupAt(0) : null);
  }

  /**
   * Lowers the floor below the parts at some times; must be followed by an update.
   * @param {(i: number) => (name: string) => number | undefined} lookupAt values at the times @param {number} count number of times
   */
  lower(lookupAt, count, parts = this.parts) {
    for (let i = 0; i < count; i++) {
      parts.update(lookupAt(i));
      const box = parts.bounds();
      if (box !== null) this.floor = Math.min(this.floor, this._lowest(box));
    }
  }

  /** Adds fixed cameras along a path. @param {number[][]} path earth positions of the followed body, m */
  stand(path) {
    this.cameras?.stand(path);
  }

  /** Whether the scene has parts that `set` can change. @returns {{arrows: boolean, stress: boolean, deformation: boolean, closed: boolean}} */
  get has() {
    const { arrows, flexible } = this.parts;
    return {
      arrows: arrows.list.length > 0,
      stress: flexible.some(({ bending }) => bending.stress !== null),
      deformation: flexible.length > 0,
      closed: this.parts.materials.hasCovers,
    };
  }

  /** Factor that makes the largest displacement so far visible. @returns {number} 1, 2, 5, 10, ... */
  get fittingDeformation() {
    return this.parts.fittingFactor(this.extent);
  }

  /**
   * Changes the look of the next picture.
   * @param {object} options any of these keys
   * @param {boolean | string[]} [options.arrows] all, none, or names
   * @param {number} [options.arrowScale] factor of the length of arrows
   * @param {boolean} [options.stress] colours of stress
   * @param {number} [options.stressMost] stress of the last colour, in its unit; 0: the largest so far
   * @param {number} [options.deformation] factor of displacements of flexible bodies
   * @param {boolean} [options.closed] whether bodies hide parts inside
   * @param {string} [options.quality]
   */
  set({ arrows, arrowScale, stress, stressMost, deformation, closed, quality }) {
    const { parts } = this;
    if (arrows !== undefined) parts.arrows.shown = new Set(arrows === true ? parts.arrows.list.map(({ name }) => name) : arrows || []);
    if (arrowScale !== undefined) parts.arrows.factor = arrowScale;
    if (stress !== undefined) parts.bending.coloured = stress;
    if (stressMost !== undefined) Object.assign(parts.bending, { most: stressMost, fixed: stressMost > 0 });
    if (deformation !== undefined) for (const { bending } of [parts, ...this.ghosts]) bending.factor = deformation;
    if (closed !== undefined) for (const each of [parts, ...this.ghosts]) each.close(closed);
    if (quality !== undefined) this.look?.choose(quality);
    this.update(this.lookup);
  }

  /** Updates the legends. */
  _updateLegends() {
    const { bending, flexible, arrows } = this.parts;
    const stressed = flexible.filter(({ bending: { stress } }) => stress !== null);
    const { unit: name, limit, limitName } = stressed[0]?.bending ?? {};
    const known = stressed.some((body) => body.stressed);
    const computed = stressed.some(({ absent }) => absent !== null);
    const state = { known, computed, most: bending.most || 1, ends: bending.fixed, unit: name, limit, limitName, factor: bending.factor };
    this.legends.put("stress", stressed.length > 0 && bending.coloured && !this.parts.closed ? state : null, stressLegend);
    const units = [...new Set(arrows.now.map((force) => force.unit))];
    const scales = units.map((of) => ({ unit: of, ...arrows.scaleOf(of), colour: arrows.colourOf(of) }));
    this.legends.put("arrows", scales.length > 0 ? scales : null, arrowLegend);
    this.legends.put("grid", (this.options.words !== false && this.look?.caption) || null, (caption) => [caption]);
  }

  /**
   * Adds another run as a transparent ghost, with an `update` as that of the view.
   * @param {Data} scene
   * @param {{tint?: string, name?: string}} [options]
   * @returns {{update: Function, remove: Function, lower: Function}} `lower` as that of the view
   */
  addGhost(scene, options = {}) {
    const parts = new Parts(scene, { ...options, ghost: true, over: this.parts, size: this.extent, tell: (sentence) => this.notes.tell(sentence) });
    parts.bending.factor = this.parts.bending.factor;
    if (this.parts.closed !== undefined) parts.close(this.parts.closed);
    this.ghosts.push(parts);
    this.world?.add(parts.group);
    const remove = () => {
      this.ghosts = this.ghosts.filter((ghost) => ghost !== parts);
      parts.dispose();
    };
    return { update: (lookup) => parts.update(lookup), remove, lower: (lookupAt, count) => this.lower(lookupAt, count, parts) };
  }

  /** Draws the picture. */
  render() {
    if (this.problem || this.lost) return;
    this.look.before();
    for (const parts of [this.parts, ...this.ghosts]) parts.place(this.origin);
    this.cameras.follow();
    for (const ghost of this.ghosts) ghost.group.visible = !this.cameras.within(ghost);
    this.look.follow();
    this.renderer.render(this.world, this.cameras.current);
    this.drawn = true;
    this.marks.place();
    this.look.after();
  }

  /** Chooses a camera. @param {string} name one of `cameraNames` */
  camera(name) {
    this.cameras?.choose(name);
  }

  /**
   * Position of a point in the picture, pixels of the page from the top left corner of the container.
   * @param {number[]} point earth position, m
   * @returns {number[] | null} null behind the camera or without a picture
   */
  project(point) {
    if (this.problem) return null;
    this.cameras.follow();
    const camera = this.cameras.current;
    camera.updateMatrixWorld();
    const [x, y, z] = subtract(point, this.origin);
    const seen = new THREE.Vector3(x, y, z).applyMatrix4(camera.matrixWorldInverse);
    if (camera instanceof THREE.PerspectiveCamera && seen.z >= 0) return null;
    seen.applyMatrix4(camera.projectionMatrix);
    return [((seen.x + 1) / 2) * this.size[0], ((1 - seen.y) / 2) * this.size[1]];
  }

  /**
   * Labels the object at a pixel with its name and values: the stress of a tube, or position and forces of a body.
   * @param {number} x @param {number} y pixels of the page from the top left corner of the container
   * @returns {string[]} lines of the label; empty without a moving object
   */
  pick(x, y) {
    return this.problem ? [] : this.marks.pick(x, y);
  }

  /** Width and height of the drawn picture, which the page scales, pixels. @returns {number[]} */
  get pixels() {
    const { width = 0, height = 0 } = this.renderer?.domElement ?? {};
    return [width, height];
  }

  /** Fits the picture to the container. */
  resize() {
    if (this.problem) return;
    this.size = [Math.max(1, this.container.clientWidth), Math.max(1, this.container.clientHeight)];
    this.renderer.setPixelRatio(this.look.pixelRatio(this.size[0] * this.size[1]));
    this.renderer.setSize(this.size[0], this.size[1], false);
    this.cameras.resize(...this.size);
  }

  /** Redraws after a change of the size, which clears the canvas. */
  _resized() {
    const { clientWidth, clientHeight } = this.container;
    if (clientWidth === this.size[0] && clientHeight === this.size[1]) return;
    this.resize();
    if (this.drawn) this.render();
  }

  /** Frees the graphics card and removes the picture. */
  dispose() {
    this.gone = true;
    this.observer?.disconnect();
    for (const parts of [this.parts, ...this.ghosts]) parts.dispose();
    this.notes.dispose();
    if (!this.renderer) return;
    this.cameras.dispose();
    this.look.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.renderer.domElement.remove();
  }

  /** Computes the size of the drawing and its centre in axes of the focus. */
  _measure() {
    const bounds = this.parts.bounds() ?? [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]]; // prettier-ignore
    const size = Math.hypot(...subtract(bounds[1], bounds[0])) || 1;
    this.extent = this.scene.extent > 0 ? this.scene.extent : size;
    this.parts.arrows.extent = this.extent;
    this._fit(bounds);
    this.reach = [this.extent, this.extent];
  }

  /** Sets centre and floor to those of a box in earth axes. @param {number[][]} bounds low and high corner */
  _fit(bounds) {
    this.bounds = bounds;
    const [low, high] = bounds;
    const sides = subtract(high, low);
    this.reach = [Math.max(sides[0], 0.3 * this.extent), Math.max(sides[1], 0.3 * this.extent)];
    this.radius = Math.max(Math.hypot(...sides), 0.5 * this.extent) / 2;
    const { position, rotation, shown } = this.parts.frames.pose(this.scene.focus || "ground");
    const centre = middle(low, high);
    this.floor = this._lowest(bounds);
    this.centre = shown ? rotate(transpose(rotation), subtract(centre, position)) : centre;
    this.origin = centre;
  }

  /** Height of a floor just below a box, m. @param {number[][]} box low and high corner */
  _lowest(box) {
    return Math.min(...box.map((corner) => dot(corner, this.up))) - 0.002 * this.extent;
  }

  _fail(sentence) {
    this.problem = sentence;
    this.size = [1, 1];
    this.notes.instead(sentence);
    globalThis.ALi3ViewerProblem = sentence;
  }

  _watchContext() {
    const canvas = this.renderer.domElement;
    canvas.addEventListener("webglcontextlost", (event) => {
      if (this.gone) return;
      event.preventDefault(); // allows the context to be restored
      this.lost = true;
      this.notes.instead("The graphics card has taken its drawing context back; the picture returns when it is given again.");
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.lost = false;
      this.notes.instead("");
      this.look.restore();
      this.render();
    });
  }
}
