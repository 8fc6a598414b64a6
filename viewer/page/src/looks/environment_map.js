// The environment map, which materials reflect: a scene of lamps or sky, blurred for each roughness.
import * as THREE from "three";

/** Side of a coarse map, pixels; the least of three.js is 256, which takes seconds on a processor. */
const COARSE_SIDE = 64;
/** Side of the faces that are summed for rough levels; the 16 of three.js takes most of the time to the first picture. */
const SUMMED_SIDE = 8;

/** A generator of coarse maps, which changes private members of three.js. @param {THREE.WebGLRenderer} renderer */
function coarseGenerator(renderer) {
  const generator = new THREE.PMREMGenerator(renderer);
  const members = /** @type {Data} */ (generator);
  const render = members._renderCube.bind(generator);
  members._setSize = () => (members._cubeSize = COARSE_SIDE);
  members._renderCube = (/** @type {Data} */ target, /** @type {number} */ lod, /** @type {THREE.ShaderMaterial} */ material) => {
    const { roughness, sourceSize, sourceLod } = material.uniforms;
    if (sourceSize) [sourceSize.value, sourceLod.value] = [SUMMED_SIDE, Math.log2(COARSE_SIDE / SUMMED_SIDE)];
    const rays = members._ggxMaterial; // 256 samples per pixel; three.js would use 768 also in the second level
    if (lod === 1) rays.uniforms.roughness.value = roughness.value;
    render(target, lod, lod === 1 ? rays : material);
  };
  return generator;
}

/**
 * Makes the environment map of a view from a scene, which is then freed.
 * @param {Data} view the SceneView
 * @param {() => THREE.Scene} makeSurroundings
 * @param {{fine: boolean, intensity: number}} options
 * @returns {{bake: () => void, dispose: () => void}} bake: redraws the map, as after a loss of the context
 */
export function reflecting({ world, renderer }, makeSurroundings, { fine, intensity }) {
  let map = null;
  const bake = () => {
    map?.dispose();
    const surroundings = makeSurroundings();
    const generator = fine ? new THREE.PMREMGenerator(renderer) : coarseGenerator(renderer);
    map = generator.fromScene(surroundings, 0, 0.1, 100);
    generator.dispose();
    surroundings.traverse((/** @type {THREE.Mesh} */ part) => {
      part.geometry?.dispose();
      for (const material of [part.material ?? []].flat()) material.dispose();
    });
    world.environment = map.texture;
  };
  world.environmentIntensity = intensity;
  bake();
  return { bake, dispose: () => map.dispose() };
}
