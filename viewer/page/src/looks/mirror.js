// What things mirror: a scene of lamps or sky, blurred for every roughness.
import * as THREE from "three";

/** Side of the coarse mirror; three.js asks for at least 256, which takes the processor seconds. */
const COARSE = 64;
/** Side of what its rough levels sum; by 16, as three.js does, most of the time until a first picture goes into it. */
const SUMMED = 8;

/** @param {THREE.WebGLRenderer} renderer */
function coarseGenerator(renderer) {
  const made = new THREE.PMREMGenerator(renderer);
  const inside = /** @type {Data} */ (made); // three.js keeps these to itself
  const render = inside._renderCube.bind(made);
  inside._setSize = () => (inside._cubeSize = COARSE);
  inside._renderCube = (/** @type {Data} */ target, /** @type {number} */ lod, /** @type {THREE.ShaderMaterial} */ material) => {
    const { roughness, sourceSize, sourceLod } = material.uniforms;
    if (sourceSize) [sourceSize.value, sourceLod.value] = [SUMMED, Math.log2(COARSE / SUMMED)];
    const rays = inside._ggxMaterial; // three.js would sum 768 places for each pixel of the second level, too
    if (lod === 1) rays.uniforms.roughness.value = roughness.value;
    render(target, lod, lod === 1 ? rays : material);
  };
  return made;
}

/**
 * @param {THREE.WebGLRenderer} renderer
 * @param {THREE.Scene} around what stands around; its things are freed
 * @param {boolean} fine
 * @returns {THREE.WebGLCubeRenderTarget} its texture is the environment of a scene
 */
export function mirrorOf(renderer, around, fine) {
  const generator = fine ? new THREE.PMREMGenerator(renderer) : coarseGenerator(renderer);
  const target = generator.fromScene(around, 0, 0.1, 100);
  generator.dispose();
  around.traverse((/** @type {THREE.Mesh} */ part) => {
    part.geometry?.dispose();
    for (const material of [part.material ?? []].flat()) material.dispose();
  });
  return target;
}
