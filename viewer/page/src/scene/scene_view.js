// A picture of a scene in an element of a page.
import * as THREE from "three";
import { Cameras } from "./cameras.js";
import { add, middle, rotate, subtract, transpose, unit } from "./math.js";
import { Notes } from "./notes.js";
import { Parts } from "./parts.js";
import { makeRenderer } from "./renderer.js";
import { makeLook } from "../looks/index.js";

/** Draws a scene; numbers come by column name. Everything is drawn relative to the focus, so that 100 km shake nothing. */
export class SceneView {
  /**
   * @param {HTMLElement} container an element with a size; the picture fills it
   * @param {object} scene see viewer/scene.schema.json
   * @param {object} [options]
   * @param {"high" | "low" | "auto"} [options.quality] auto: by the measured time of a picture
   * @param {"outdoors" | "studio" | "board"} [options.look] by default after the scene
   * @param {string} [options.camera] the first camera
   * @param {boolean} [options.keep] the picture can be read from the canvas after it is drawn
   * @param {(sentence: string) => void} [options.onMessage] told what is not drawn, once each
   */
  constructor(container, scene, options = {}) {
    this.container = container;
    this.scene = scene;
    this.options = options;
    /** One sentence where nothing can be drawn, else empty. */
    this.problem = "";
    if (getComputedStyle(container).position === "static") container.style.position = "relative";
    this.notes = new Notes(container, options.onMessage);
    const tell = (sentence) => this.notes.tell(sentence);
    this.parts = new Parts(scene, { tell });
    this.ghosts = [];
    this.up = unit(scene.up ?? [0, 0, 1]) ?? [0, 0, 1];
    this.#measure();
    const { renderer, software, problem } = makeRenderer(container, {
      antialias: options.quality === "high" ? true : undefined,
      keep: options.keep,
    });
    if (problem !== undefined) {
      this.#fail(problem);
      return;
    }
    this.renderer = renderer;
    this.software = software;
    this.world = new THREE.Scene();
    this.world.add(this.parts.group);
    this.cameras = new Cameras(this, renderer.domElement);
    this.look = makeLook(this);
    this.#watchContext();
    this.camera(options.camera ?? this.cameras.names[0]);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(container);
    this.resize();
    this.update(null);
  }

  /** Sentences about what is not drawn. @returns {string[]} */
  get messages() {
    return this.problem ? [this.problem, ...this.notes.said] : this.notes.said;
  }

  /** Names that `camera` takes. @returns {string[]} */
  get cameraNames() {
    return this.cameras?.names ?? [];
  }

  /**
   * Move everything to the numbers of an instant.
   * @param {((name: string) => number | undefined) | null} lookup the number of a column; null: the scene as drawn
   */
  update(lookup) {
    this.parts.update(lookup);
    const { position, rotation, shown } = this.parts.frames.pose(this.scene.focus || "ground");
    if (shown) this.origin = add(position, rotate(rotation, this.centre));
  }

  /**
   * Another run beside this one, see-through; its `update` takes numbers as that of the view.
   * @param {object} scene
   * @param {{tint?: string, opacity?: number, name?: string}} [options]
   * @returns {{update: Function, remove: Function}}
   */
  addGhost(scene, options = {}) {
    const parts = new Parts(scene, { ...options, ghost: true, tell: (sentence) => this.notes.tell(sentence) });
    this.ghosts.push(parts);
    this.world?.add(parts.group);
    const remove = () => {
      this.ghosts = this.ghosts.filter((ghost) => ghost !== parts);
      parts.dispose();
    };
    return { update: (lookup) => parts.update(lookup), remove };
  }

  /** Draw the picture now. */
  render() {
    if (this.problem || this.lost) return;
    const began = performance.now();
    for (const parts of [this.parts, ...this.ghosts]) parts.place(this.origin);
    this.cameras.follow();
    this.look.follow();
    this.renderer.render(this.world, this.cameras.current);
    this.look.measured(performance.now() - began);
  }

  /** @param {string} name one of `cameraNames` */
  camera(name) {
    this.cameras?.choose(name);
  }

  /**
   * Where a point of the earth stands in the picture: pixels of the page from the top left corner of the container.
   * @param {number[]} point earth coordinates
   * @returns {number[] | null} null behind the camera or where there is no picture
   */
  project(point) {
    if (this.problem) return null;
    this.cameras.follow();
    const camera = this.cameras.current;
    camera.updateMatrixWorld();
    const [x, y, z] = subtract(point, this.origin);
    const seen = new THREE.Vector3(x, y, z).applyMatrix4(camera.matrixWorldInverse);
    if (camera.isPerspectiveCamera && seen.z >= 0) return null;
    seen.applyMatrix4(camera.projectionMatrix);
    return [((seen.x + 1) / 2) * this.size[0], ((1 - seen.y) / 2) * this.size[1]];
  }

  /** Fit the picture to the container. */
  resize() {
    if (this.problem) return;
    this.size = [Math.max(1, this.container.clientWidth), Math.max(1, this.container.clientHeight)];
    this.renderer.setPixelRatio(this.look.pixelRatio);
    this.renderer.setSize(...this.size, false);
    this.cameras.resize(...this.size);
  }

  /** Free what the graphics card holds and take the picture out of the page. */
  dispose() {
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

  /** Size of what is drawn and its middle, in the axes of the focus. */
  #measure() {
    this.bounds = this.parts.bounds() ?? [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]];
    const [low, high] = this.bounds;
    this.extent = this.scene.extent > 0 ? this.scene.extent : Math.hypot(...subtract(high, low)) || 1;
    const { position, rotation, shown } = this.parts.frames.pose(this.scene.focus || "ground");
    const centre = middle(low, high);
    this.centre = shown ? rotate(transpose(rotation), subtract(centre, position)) : centre;
    this.origin = centre;
  }

  #fail(sentence) {
    this.problem = sentence;
    this.size = [1, 1];
    this.notes.instead(sentence);
    globalThis.ALi3ViewerProblem = sentence;
  }

  #watchContext() {
    const canvas = this.renderer.domElement;
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // asks for it back
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
