// Where one looks from.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { across, add, cross, dot, rotate, scale, subtract, unit } from "./math.js";

/** The cameras of a view; places are relative to the origin of the picture. */
export class Cameras {
  /** @param {object} view the SceneView @param {HTMLElement} element takes mouse and touch */
  constructor(view, element) {
    this.view = view;
    const { extent, up, scene } = view;
    const range = [extent * 1e-3, Math.max(extent * 400, 50)];
    this.perspective = new THREE.PerspectiveCamera(36, 1, ...range);
    this.perspective.up.set(...up);
    this.flat = new THREE.OrthographicCamera(-1, 1, 1, -1, -range[1], range[1]);
    this.flat.up.set(...up);
    this.names = scene.planar ? ["orbit"] : ["orbit", ...(scene.focus ? ["chase"] : []), "side", "top"];
    this.free = scene.planar ? this.flat : this.perspective;
    this.#stand();
    this.controls = new OrbitControls(this.free, element);
    this.controls.enableDamping = false;
    if (scene.planar) {
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.current = this.free;
    this.name = "orbit";
  }

  /** The first place of the free camera. */
  #stand() {
    const { extent, up } = this.view;
    if (this.view.scene.planar) {
      this.free.position.set(0, 0, extent);
      this.free.lookAt(0, 0, 0);
      return;
    }
    const [side, forward] = this.#axes();
    const from = unit(add(add(scale(forward, 0.75), scale(side, -1)), scale(up, 0.5)));
    this.free.position.set(...scale(from, extent * 1.75));
    this.free.lookAt(0, 0, 0);
  }

  /** Left and forward of what is followed, level. */
  #axes() {
    const { up, scene, parts } = this.view;
    const { rotation, shown } = parts.frames.pose(scene.focus || "ground");
    const x = shown ? rotate(rotation, [1, 0, 0]) : [1, 0, 0];
    const forward = unit(subtract(x, scale(up, dot(x, up)))) ?? across(up);
    return [cross(up, forward), forward];
  }

  /** @param {string} name */
  choose(name) {
    if (!this.names.includes(name)) {
      throw new Error(`There is no camera '${name}'; there are ${this.names.join(", ")}.`);
    }
    this.name = name;
    this.controls.enabled = name === "orbit";
    if (name === "orbit") this.controls.update();
    this.follow();
  }

  /** Goes along with what is followed. */
  follow() {
    if (this.name === "orbit") return;
    const { extent, up } = this.view;
    const [side, forward] = this.#axes();
    const from = {
      chase: add(scale(forward, -1.6 * extent), scale(up, 0.5 * extent)),
      side: add(scale(side, -1.8 * extent), scale(up, 0.15 * extent)),
      top: add(scale(up, 3 * extent), scale(forward, -1e-3 * extent)),
    }[this.name];
    this.perspective.position.set(...from);
    this.perspective.lookAt(0, 0, 0);
  }

  resize(width, height) {
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    const half = 0.62 * this.view.extent;
    const [x, y] = width > height ? [(half * width) / height, half] : [half, (half * height) / width];
    Object.assign(this.flat, { left: -x, right: x, top: y, bottom: -y });
    this.flat.updateProjectionMatrix();
  }

  dispose() {
    this.controls.dispose();
  }
}
