// Makes the surroundings of a studio for reflections: a bright sphere with lamps.
import * as THREE from "three";
import { across, cross } from "../scene/math.js";

/** Makes the scene of the lamps. @param {number[]} up @returns {THREE.Scene} */
export function room(up) {
  const x = across(up);
  const y = cross(up, x);
  const place = (mesh, a, b, c) => {
    mesh.position.set(...[0, 1, 2].map((i) => a * x[i] + b * y[i] + c * up[i]));
    mesh.lookAt(0, 0, 0);
  };
  const scene = new THREE.Scene();
  const wall = new THREE.MeshBasicMaterial({ color: new THREE.Color(0.62, 0.64, 0.67), side: THREE.BackSide });
  scene.add(new THREE.Mesh(new THREE.SphereGeometry(20, 24, 16), wall));
  const lamp = (strength, wide, high) => {
    const colour = new THREE.Color(strength, strength, 0.98 * strength);
    return new THREE.Mesh(new THREE.PlaneGeometry(wide, high), new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide }));
  };
  const floor = lamp(0.3, 30, 30);
  /** @type {[THREE.Mesh, number, number, number][]} */
  const lamps = [[lamp(7, 10, 6), 2, 1, 13], [lamp(4, 4, 10), 13, -4, 4], [lamp(3, 3, 9), -12, -6, 3], [lamp(2.5, 8, 3), -3, 13, 6], [floor, 0, 0, -9]]; // prettier-ignore
  for (const [mesh, a, b, c] of lamps) {
    place(mesh, a, b, c);
    scene.add(mesh);
  }
  return scene;
}
