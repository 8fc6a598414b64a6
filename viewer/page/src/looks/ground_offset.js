// Depth offset of things on the ground: at the same place in the picture, and never covered by the ground.
import * as THREE from "three";
import { atEachPixel, atEachPoint } from "./vertex_code.js";

/** Shares of the distance by which paint, and what lies on paint, is drawn nearer. */
export const [PAINT, MARKS] = [0.004, 0.006];
/** Metres by which they lie above the ground. */
export const LIFT = 0.004;

/**
 * Lines thinner than some pixels are drawn as wide as that and so much fainter: the same light, and no dots instead of a
 * line. The attribute `aside` goes from the middle of a line to its edge.
 * @param {Data} shader of three.js @param {{value: Data}} viewport pixels
 * @param {{up?: number[], least?: number, fainter?: boolean}} [options] up: unit vector across which lines lie; least:
 *   pixels; fainter: false for what is no paint and is to be found however far it is
 */
export function widen(shader, viewport, { up = [0, 0, 1], least = 1.2, fainter = true } = {}) {
  shader.uniforms.aViewport = viewport;
  atEachPoint(
    shader,
    "attribute vec3 aside;\nuniform vec2 aViewport;\nvarying float vThin;",
    `mat4 seen = projectionMatrix * modelViewMatrix;
vec4 edgeSeen = seen * vec4(position, 1.0);
vec4 middleSeen = seen * vec4(position - aside, 1.0);
vec4 aheadSeen = seen * vec4(position - aside + cross(vec3(${up.map((value) => value.toFixed(6))}), aside), 1.0);
vThin = 1.0;
if (min(min(edgeSeen.w, middleSeen.w), aheadSeen.w) > 0.0) {
  vec2 middle = middleSeen.xy / middleSeen.w;
  vec2 across = (edgeSeen.xy / edgeSeen.w - middle) * 0.5 * aViewport;
  vec2 ahead = normalize((aheadSeen.xy / aheadSeen.w - middle) * aViewport + 1e-9);
  float halfWidth = abs(across.x * ahead.y - across.y * ahead.x);
  float grow = clamp(${(0.5 * least).toFixed(2)} / max(halfWidth, 1e-3), 1.0, 40.0);
  transformed += aside * (grow - 1.0);
  vThin = ${fainter ? "1.0 / grow" : "1.0"};
}`,
  );
  atEachPixel(shader, "varying float vThin;", { color_fragment: "diffuseColor.a *= vThin;" });
}

/** @param {Data} shader of three.js @param {number} share of the distance */
export function lift(shader, share) {
  shader.vertexShader = shader.vertexShader.replace(
    "#include <project_vertex>",
    `#include <project_vertex>\ngl_Position = projectionMatrix * vec4(mvPosition.xyz * ${(1 - share).toFixed(4)}, 1.0);`,
  );
}

/**
 * A material of what is laid on the ground and lets it shine through.
 * @param {string} key of its program @param {number} share of the distance by which it is drawn nearer @param {Data} look
 * @param {(shader: Data) => void} change of its program
 */
export function laid(key, share, look, change) {
  const material = new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false, side: THREE.DoubleSide, forceSinglePass: true, ...look });
  material.onBeforeCompile = (shader) => {
    change(shader);
    lift(shader, share);
  };
  material.customProgramCacheKey = () => `ali3-${key}`;
  return material;
}
