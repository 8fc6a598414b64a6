// Depth offset of objects on the ground, which keeps their position in the picture and prevents hiding by the ground.
import * as THREE from "three";
import { atEachPixel, atEachPoint } from "./vertex_code.js";

/** Depth offsets of paint and of marks on paint, as shares of the distance. */
export const [PAINT, MARKS] = [0.004, 0.006];
/** Height of paint and marks above the ground, m. */
export const LIFT = 0.004;

/**
 * Widens thin lines in a shader to a least width and makes them fainter, so that they do not break into dots. The
 * attribute `aside` is the vector from the middle of a line to its edge.
 * @param {Data} shader of three.js @param {{value: Data}} viewport pixels
 * @param {{up?: number[], least?: number, fainter?: boolean}} [options] up: unit normal of lines; least: least width,
 *   pixels; fainter: false for lines that stay visible at any distance
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

/** Adds a depth offset to a shader. @param {Data} shader of three.js @param {number} share of the distance */
export function lift(shader, share) {
  shader.vertexShader = shader.vertexShader.replace(
    "#include <project_vertex>",
    `#include <project_vertex>\ngl_Position = projectionMatrix * vec4(mvPosition.xyz * ${(1 - share).toFixed(4)}, 1.0);`,
  );
}

/**
 * Makes a transparent material of marks on the ground.
 * @param {string} key of its program @param {number} share depth offset, of the distance @param {Data} look
 * @param {(shader: Data) => void} change further changes of the shader
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
