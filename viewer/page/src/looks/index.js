// The look of a picture: light, sky, ground.
import * as THREE from "three";

/** @param {object} view the SceneView */
export function makeLook(view) {
  const { world, renderer, up, extent } = view;
  world.background = new THREE.Color("#e9edf0");
  const sun = new THREE.DirectionalLight("#ffffff", 2.4);
  sun.position.set(...up.map((u, i) => (u * 3 + [0.8, -1.2, 0.6][i]) * extent));
  const sky = new THREE.HemisphereLight("#ffffff", "#8a8f94", 1.6);
  sky.position.set(...up);
  world.add(sun, sky);
  renderer.toneMapping = THREE.ACESFilmicToneMapping;
  return { pixelRatio: 1, follow() {}, measured() {}, restore() {}, dispose() {} };
}
