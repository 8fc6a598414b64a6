// The environment map, which things reflect: a scene of lamps or sky, blurred for every roughness.
import * as THREE from "three";

/** Side of a coarse map in pixels; three.js takes at least 256, seconds where the processor draws. */
const COARSE = 64;
/** Side of the faces of which rough levels are sums; the 16 of three.js is most of the time until a first picture. */
const SUMMED = 8;

/** A generator of coarse maps, by members that three.js keeps private. @param {THREE.WebGLRenderer} renderer */
function coarseGenerator(renderer) {
  const generator = new THREE.PMREMGenerator(renderer);
  const inside = /** @type {Data} */ (generator);
  const render = inside._renderCube.bind(generator);
  inside._setSize = () => (inside._cubeSize = COARSE);
  inside._renderCube = (/** @type {Data} */ target, /** @type {number} */ lod, /** @type {THREE.ShaderMaterial} */ material) => {
    const { roughness, sourceSize, sourceLod } = material.uniforms;
    if (sourceSize) [sourceSize.value, sourceLod.value] = [SUMMED, Math.log2(COARSE / SUMMED)];
    const rays = inside._ggxMaterial; // 256 a pixel; three.js would sum 768 places in the second level, too
    if (lod === 1) rays.uniforms.roughness.value = roughness.value;
    render(target, lod, lod === 1 ? rays : material);
  };
  return generator;
}

/**
 * Lets things of a view reflect what stands around, whose things are freed.
 * @param {Data} view the SceneView
 * @param {() => THREE.Scene} around
 * @param {{fine: boolean, intensity: number}} options
 * @returns {{bake: () => void, dispose: () => void}} bake: draw the map again, as after a loss of the context
 */
export function reflecting({ world, renderer }, around, { fine, intensity }) {
  let map = null;
  const bake = () => {
    map?.dispose();
    const things = around();
    const generator = fine ? new THREE.PMREMGenerator(renderer) : coarseGenerator(renderer);
    map = generator.fromScene(things, 0, 0.1, 100);
    generator.dispose();
    things.traverse((/** @type {THREE.Mesh} */ part) => {
      part.geometry?.dispose();
      for (const material of [part.material ?? []].flat()) material.dispose();
    });
    world.environment = map.texture;
  };
  world.environmentIntensity = intensity;
  bake();
  return { bake, dispose: () => map.dispose() };
}
