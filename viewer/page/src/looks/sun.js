// Makes the light that casts shadows around the focus.
import * as THREE from "three";

/**
 * Makes the light.
 * @param {{direction: number[], reach: number, strength: number, color: string, size: number}} options
 *   direction: to the light; reach: half the side of the area with shadows, m; size: side of the shadow map, pixels
 */
export function sunLight({ direction, reach, strength, color, size }) {
  const light = new THREE.DirectionalLight(color, strength);
  light.position.fromArray(direction.map((d) => d * 4 * reach));
  light.castShadow = true;
  Object.assign(light.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.5 * reach, far: 9 * reach });
  light.shadow.mapSize.set(size, size);
  light.shadow.bias = -2e-4;
  light.shadow.normalBias = (5 * reach) / size;
  light.shadow.radius = 2.5;
  light.shadow.intensity = 0.95;
  return light;
}

/** Changes the size of the shadow map. @param {THREE.DirectionalLight} light @param {number} size pixels */
export function sharpen(light, size) {
  if (light.shadow.mapSize.x === size) return;
  light.shadow.mapSize.set(size, size);
  light.shadow.map?.dispose();
  light.shadow.map = null;
}
