// The look for planar mechanisms: a white board with a grid in metres, and uniform light.
import * as THREE from "three";
import { niceStep } from "../scene/forces.js";
import { discard } from "./discard.js";
import { gridSurface } from "./grid.js";
import { reflecting } from "./environment_map.js";
import { room } from "./room.js";

/** Makes the look. @param {Data} view the SceneView @param {boolean} fine */
export function board(view, fine) {
  const { world, renderer, extent } = view;
  world.background = new THREE.Color("#ffffff");
  renderer.toneMapping = THREE.NoToneMapping;
  const front = new THREE.DirectionalLight("#ffffff", 1.5);
  front.position.set(-0.5, 0.9, 1.6);
  world.add(front);
  const step = niceStep(extent / 8);
  const reach = 12 * extent;
  const grid = gridSurface({ x: [1, 0, 0], y: [0, 1, 0], step, reach, color: "#ffffff", ink: "#b4bec6", lit: false });
  world.add(grid.mesh);
  const light = reflecting(view, () => room([0, 0.6, 0.8]), { fine, intensity: 0.8 });
  return {
    caption: `grid ${step} m`,
    follow(origin) {
      grid.follow(origin);
      grid.mesh.position.set(0, 0, -2 * extent);
    },
    quality() {},
    restore: light.bake,
    tell: [],
    dispose() {
      discard(grid.mesh);
      light.dispose();
    },
  };
}
