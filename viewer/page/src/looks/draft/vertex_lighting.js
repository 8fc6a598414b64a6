// Materials with lighting computed only at points, the least expensive that shows forms.
import * as THREE from "three";
import { atEachPixel, atEachPoint } from "../vertex_code.js";

/** Diffuse light of the sky, including that of environment maps of other materials. */
const SKY = "vec3(0.42, 0.55, 0.8)";

const VERTEX = /* glsl */ `
vec3 facing = normal;
#ifdef USE_BATCHING
facing = mat3(batchingMatrix) * facing;
#endif
#ifdef USE_INSTANCING
facing = mat3(instanceMatrix) * facing;
#endif
facing = normalize(mat3(modelMatrix) * facing);
vLit = max(dot(facing, aTo), 0.0) * aLight + ${SKY} * (0.75 + 0.25 * dot(facing, aUp));`;

/** The transfer function of sRGB by roots, which are faster than powers; the largest error is 2 of 255, near black. */
const SRGB = /* glsl */ `
vec3 root = sqrt(gl_FragColor.rgb);
vec3 fourth = sqrt(root);
gl_FragColor.rgb = 0.662002687 * root + 0.684122060 * fourth - 0.323583601 * sqrt(fourth) - 0.0225411470 * gl_FragColor.rgb;`;

/** Uniforms of the light of a picture. @param {THREE.DirectionalLight} sun @param {number[]} up */
export function lightOf(sun, up) {
  const strength = new THREE.Vector3(sun.color.r, sun.color.g, sun.color.b).multiplyScalar(sun.intensity / Math.PI);
  return { aTo: { value: sun.position.clone().normalize() }, aLight: { value: strength }, aUp: { value: new THREE.Vector3(...up) }, aLeast: { value: 0 } };
}

/**
 * Makes a material that is lit at its points.
 * @param {Data} light of `lightOf`
 * @param {THREE.MeshBasicMaterialParameters} look
 * @param {string} key of the program, unique for each `more`
 * @param {(shader: Data) => void} [more] further changes of the shader
 */
export function vertexLit(light, look, key, more = () => {}) {
  const material = new THREE.MeshBasicMaterial(look);
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, light);
    atEachPoint(shader, "uniform vec3 aTo, aLight, aUp;\nvarying vec3 vLit;", VERTEX);
    atEachPixel(shader, "varying vec3 vLit;", { color_fragment: "diffuseColor.rgb *= vLit;" });
    shader.fragmentShader = shader.fragmentShader.replace("#include <colorspace_fragment>", SRGB);
    more(shader);
  };
  material.customProgramCacheKey = () => `ali3-vertex-lit-${key}`;
  return material;
}
