// Makes a floor or wall with a grid in metres, fixed to the earth.
import * as THREE from "three";
import { dot, modulo } from "../scene/math.js";
import { atEachPixel, onTheEarth } from "./vertex_code.js";

const CODE = /* glsl */ `
vec2 plane = vec2(dot(vGround, aX), dot(vGround, aY));
vec2 soft = max(fwidth(plane), 1e-7);
vec2 fine = abs(mod(plane + aOffset[0] + 0.5 * aStep, aStep) - 0.5 * aStep) / soft;
vec2 bold = abs(mod(plane + aOffset[1] + 2.5 * aStep, 5.0 * aStep) - 2.5 * aStep) / soft;
vec2 thin = (1.0 - smoothstep(0.5, 1.5, fine)) * clamp(0.25 * aStep / soft - 0.5, 0.0, 1.0);
vec2 thick = (1.0 - smoothstep(0.6, 1.6, bold)) * clamp(0.25 * aStep / soft, 0.0, 1.0);
float far = length(plane) / aReach;
float ink = max(0.45 * max(thin.x, thin.y), 0.85 * max(thick.x, thick.y)) * (1.0 - smoothstep(0.35, 1.0, far));
diffuseColor.rgb = mix(diffuseColor.rgb, aInk, ink);
diffuseColor.a *= 1.0 - smoothstep(0.6, 1.0, far);
`;

/**
 * Makes a square with a grid.
 * @param {{x: number[], y: number[], step: number, reach: number, color: string, ink: string, lit: boolean}} options
 *   x, y: unit vectors of the surface; step: distance of lines, m, every fifth is bold; reach: half the side, m
 * @returns {{mesh: THREE.Mesh<THREE.PlaneGeometry, THREE.Material>, follow: (origin: number[]) => void}} to be rotated and moved by the caller
 */
export function gridSurface({ x, y, step, reach, color, ink, lit }) {
  const uniforms = {
    aX: { value: new THREE.Vector3(...x) },
    aY: { value: new THREE.Vector3(...y) },
    aOffset: { value: [new THREE.Vector2(), new THREE.Vector2()] },
    aStep: { value: step },
    aReach: { value: reach },
    aInk: { value: new THREE.Color(ink) },
  };
  const settings = { color, transparent: true, depthWrite: false };
  const material = lit
    ? new THREE.MeshLambertMaterial(settings) // the least expensive lighting, because a floor fills the picture
    : new THREE.MeshBasicMaterial({ ...settings, toneMapped: false, fog: false });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    onTheEarth(shader);
    const head = "uniform vec3 aX, aY, aInk;\nuniform vec2 aOffset[2];\nuniform float aStep, aReach;\nvarying vec3 vGround;";
    atEachPixel(shader, head, { map_fragment: CODE, lights_fragment_end: "reflectedLight.indirectDiffuse += 0.26 * diffuseColor.rgb;" });
  };
  material.customProgramCacheKey = () => `ali3-grid-${lit}`;
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2 * reach, 2 * reach), material);
  mesh.renderOrder = -1;
  const follow = (origin) => {
    const at = [dot(origin, x), dot(origin, y)];
    [step, 5 * step].forEach((period, i) => uniforms.aOffset.value[i].fromArray(at.map((a) => modulo(a, period))));
  };
  return { mesh, follow };
}
