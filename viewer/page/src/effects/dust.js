// Dust, grass, spray and smoke behind the wheels.
import * as THREE from "three";
import { discard } from "../looks/discard.js";
import { subtract } from "../scene/math.js";
import { AGE, Cloud, KINDS, ROW } from "./cloud.js";
import { Wheels } from "./wheels.js";

/** Largest number of particles in the air. */
const MAX_PARTICLES = 700;

const VERTEX = /* glsl */ `
attribute vec4 tint;
attribute float size;
uniform float pixels;
varying vec4 vTint;
#include <fog_pars_vertex>
void main() {
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * mvPosition;
  gl_PointSize = min(pixels * size * projectionMatrix[1][1] / max(0.1, gl_Position.w), 256.0);
  vTint = tint;
  #include <fog_vertex>
}`;

const FRAGMENT = /* glsl */ `
varying vec4 vTint;
#include <fog_pars_fragment>
void main() {
  float way = length(gl_PointCoord - 0.5) * 2.0;
  float share = vTint.a * (1.0 - smoothstep(0.15, 1.0, way));
  if (share < 0.004) discard;
  gl_FragColor = vec4(vTint.rgb, share);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
  #include <fog_fragment>
}`;

/** Particles that wheels throw up; new particles replace the oldest. */
export class Dust {
  /**
   * @param {import("../scene/scene_view.js").SceneView} view
   * @param {{surface?: (x: number, y: number) => string, columns?: string[]}} [options] those of Wheels
   */
  constructor(view, options = {}) {
    this.view = view;
    this.wheels = new Wheels(view.scene, options);
    /** Reason why there is no dust; empty if there is. */
    this.problem = this.wheels.problem;
    this.cloud = new Cloud(this.wheels.list.length, MAX_PARTICLES);
    if (this.problem || view.problem) return;
    this.geometry = new THREE.BufferGeometry();
    for (const [name, size] of Object.entries({ position: 3, tint: 4, size: 1 })) {
      const buffer = new THREE.BufferAttribute(new Float32Array(MAX_PARTICLES * size), size);
      this.geometry.setAttribute(name, buffer.setUsage(THREE.DynamicDrawUsage));
    }
    this.geometry.setDrawRange(0, 0);
    const material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { ...THREE.UniformsUtils.clone(THREE.UniformsLib.fog), pixels: { value: 1 } },
      transparent: true,
      depthWrite: false,
      fog: true,
    });
    this.points = new THREE.Points(this.geometry, material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 2;
    view.world.add(this.points);
  }

  /** Number of particles in the air. */
  get count() {
    return this.cloud.count;
  }

  /**
   * Updates the particles; called after the view is updated to the same values.
   * @param {(name: string) => number | undefined} lookup @param {number} time @param {number} epoch
   */
  update(lookup, time, epoch) {
    if (this.problem) return;
    const { view } = this;
    this.cloud.update(this.wheels.contacts(lookup), view.up, time, epoch);
    if (this.points === undefined) return;
    this.points.material.uniforms.pixels.value = 0.5 * view.renderer.domElement.height;
    const { position, tint, size } = this.geometry.attributes;
    let used = 0;
    for (let k = 0; k < MAX_PARTICLES; k++) {
      const age = this.cloud.rows[ROW * k + AGE];
      const { life, sizes, colour, seen } = KINDS[this.cloud.kinds[k]];
      if (!(age < life)) continue;
      const share = age / life;
      const at = subtract(this.cloud.rows.subarray(ROW * k, ROW * k + 3), view.origin);
      position.array.set(at, 3 * used);
      tint.array.set([...colour, seen * (1 - share) * Math.min(1, 12 * share + 0.3)], 4 * used);
      size.array[used] = sizes[0] + share * (sizes[1] - sizes[0]);
      used++;
    }
    for (const buffer of [position, tint, size]) buffer.needsUpdate = true;
    this.geometry.setDrawRange(0, used);
  }

  dispose() {
    discard(this.points);
  }
}
