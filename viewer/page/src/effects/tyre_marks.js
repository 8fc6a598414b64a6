// Tyre marks on the ground.
import * as THREE from "three";
import { discard } from "../looks/discard.js";
import { laid, LIFT, MARKS } from "../looks/ground_offset.js";
import { atEachPixel, atEachPoint } from "../looks/vertex_code.js";
import { subtract } from "../scene/math.js";
import { Tracks } from "./tracks.js";
import { Wheels } from "./wheels.js";

/** Largest number of sections of a wheel, for 500 m of marks. */
const MAX_SECTIONS = 4096;
/** Stride of the sections that are drawn in a draft. */
const DRAFT_STRIDE = 4;
/** Largest distance of the focus from the base point of the marks, m. */
const MAX_DISTANCE = 500;

const RUBBER = /* glsl */ `
float soft = max(fwidth(vMark.y), 1e-3);
float rib = 1.0 - 0.3 * smoothstep(0.4, 0.9, 0.5 + 0.5 * cos(vMark.y * 15.7)) * clamp(1.0 - 3.0 * soft, 0.0, 1.0);
diffuseColor.a *= vMark.x * rib * (1.0 - smoothstep(0.78, 1.0, abs(vMark.y)));`;

/** Dark strips on hard ground where tyres slide; new strips replace the oldest. */
export class TyreMarks {
  _base = null;
  _drawn = "";

  /** @param {import("../scene/scene_view.js").SceneView} view @param {{columns?: string[]}} [options] see Wheels */
  constructor(view, options = {}) {
    this.view = view;
    this.wheels = new Wheels(view.scene, options);
    /** Reason why there are no marks; empty if there are. */
    this.problem = this.wheels.problem;
    if (this.problem && this.wheels.list.length > 0) view.notes.tell(this.problem);
    this.tracks = new Tracks(this.wheels.list.length, MAX_SECTIONS);
    if (this.problem || view.problem) return;
    const count = this.wheels.list.length * MAX_SECTIONS;
    this.geometry = new THREE.BufferGeometry();
    const buffer = (size) => new THREE.BufferAttribute(new Float32Array(2 * count * size), size).setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("position", buffer(3));
    this.geometry.setAttribute("mark", buffer(2));
    this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(6 * count), 1).setUsage(THREE.DynamicDrawUsage));
    this.geometry.setDrawRange(0, 0);
    this.mesh = new THREE.Mesh(this.geometry, material());
    this.mesh.frustumCulled = false; // it lies around the focus
    this.mesh.renderOrder = 1;
    view.world.add(this.mesh);
  }

  /** Number of sections. */
  get count() {
    return this.tracks.count;
  }

  /**
   * Updates the marks; called after the view is updated to the same values.
   * @param {(name: string) => number | undefined} lookup @param {number} time @param {number} epoch
   */
  update(lookup, time, epoch) {
    this.take(lookup, time, epoch);
    if (this.mesh === undefined) return;
    const { origin } = this.view;
    if (this._base === null || Math.hypot(...subtract(origin, this._base)) > MAX_DISTANCE) {
      this._base = [...origin];
      this._drawn = "";
    }
    const every = this.view.look.quality === "draft" ? DRAFT_STRIDE : 1;
    const state = `${this.tracks.changes} ${every}`;
    if (this._drawn !== state) this._draw(every);
    this._drawn = state;
    this.mesh.position.fromArray(subtract(this._base, origin));
  }

  /** Adds sections of a time that is not drawn. @param {(name: string) => number | undefined} lookup @param {number} time @param {number} epoch */
  take(lookup, time, epoch) {
    if (!this.problem) this.tracks.update(this.wheels.contacts(lookup), time, epoch);
  }

  /** @param {number} every stride of the sections within a mark */
  _draw(every) {
    const { position, mark } = /** @type {Record<string, THREE.BufferAttribute>} */ (this.geometry.attributes);
    const index = this.geometry.index;
    const { up } = this.view;
    let [point, used] = [0, 0];
    for (const ring of this.tracks.rings) {
      for (let k = 0; k < ring.count; k++) {
        const inside = (ring.first + k) % every !== 0 && k > 0 && k + 1 < ring.count && this.tracks.row(ring, k)[6] > 0;
        if (inside && this.tracks.row(ring, k + 1)[6] > 0) continue;
        const [x, y, z, a, b, c, dark] = this.tracks.row(ring, k);
        for (const side of [-1, 1]) {
          const at = subtract([x + side * a, y + side * b, z + side * c], this._base);
          position.array.set(at.map((value, axis) => value + LIFT * up[axis]), 3 * point);
          mark.array.set([dark, side], 2 * point);
          point++;
        }
        if (k === 0 || dark === 0) continue;
        index.array.set([point - 4, point - 2, point - 3, point - 3, point - 2, point - 1], used);
        used += 6;
      }
    }
    for (const buffer of [position, mark, index]) {
      buffer.clearUpdateRanges();
      buffer.addUpdateRange(0, buffer === index ? used : point * buffer.itemSize);
      buffer.needsUpdate = true;
    }
    this.geometry.setDrawRange(0, used);
  }

  dispose() {
    discard(this.mesh);
  }
}

/** Material of rubber: black, transparent, with the ribs of a tread. */
const material = () =>
  laid("tyre-marks", MARKS, { color: "#08080a" }, (shader) => {
    atEachPoint(shader, "attribute vec2 mark;\nvarying vec2 vMark;", "vMark = mark;");
    atEachPixel(shader, "varying vec2 vMark;", { color_fragment: RUBBER });
  });
