// The look of mechanisms: a studio with a floor with a grid in metres, and soft light.
import * as THREE from "three";
import { add, cross, dot, fromColumns, scale, sideways, unit } from "../scene/math.js";
import { turn } from "../shapes/place.js";
import { niceStep } from "../scene/forces.js";
import { discard } from "./discard.js";
import { makeDraft } from "./draft/index.js";
import { gridSurface } from "./grid.js";
import { reflecting } from "./environment_map.js";
import { room } from "./room.js";
import { sunLight } from "./sun.js";

const BACKGROUND = "#dfe4e8";

/** Makes the look. @param {Data} view the SceneView @param {boolean} fine whether there is a graphics card */
export function studio(view, fine) {
  const { world, renderer, up, extent } = view;
  const x = sideways(up);
  const y = cross(up, x);
  const direction = unit(add(scale(up, 1.3), add(scale(x, 0.55), scale(y, -0.75))));
  const sun = sunLight({ direction, reach: 1.5 * view.radius, strength: 3.1, color: "#fffaf2", size: fine ? 2048 : 1024 });
  world.add(sun);
  world.background = new THREE.Color(BACKGROUND);
  renderer.toneMapping = THREE.NeutralToneMapping;
  renderer.toneMappingExposure = 1;
  const step = niceStep(extent / 8);
  const floor = gridSurface({ x, y, step, reach: 7 * extent, color: "#c3c9cf", ink: "#8d979f", lit: true });
  floor.mesh.receiveShadow = true;
  turn(floor.mesh, fromColumns(x, y, up));
  world.add(floor.mesh);
  const light = reflecting(view, () => room(up), { fine, intensity: 0.5 });
  const draft = makeDraft(view, sun);
  return {
    caption: `grid ${step} m`,
    follow(origin) {
      draft.follow();
      floor.follow(origin);
      floor.mesh.position.fromArray(scale(up, view.floor - dot(up, origin)));
    },
    quality(level) {
      draft.set(level);
    },
    restore: light.bake,
    tell: [],
    dispose() {
      draft.dispose();
      discard(floor.mesh);
      sun.dispose();
      light.dispose();
    },
  };
}
