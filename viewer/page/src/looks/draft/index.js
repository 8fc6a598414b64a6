// The draft quality, for machines without a graphics card: one call for moving parts, no shadow map, lighting at points.
import { baked } from "./baked_solids.js";
import { sharpen } from "../sun.js";
import { lightOf } from "./vertex_lighting.js";
import { leastOf } from "./tubes.js";

/**
 * Makes the draft of a picture, when it is first shown.
 * @param {Data} view the SceneView
 * @param {import("three").DirectionalLight} sun
 */
export function makeDraft(view, sun) {
  const { world, parts, extent, up } = view;
  const light = lightOf(sun, up);
  let draft = null;
  const make = () => {
    const car = baked(parts, light, extent);
    world.add(car.mesh);
    return car;
  };
  return {
    light,
    on: false,
    /** Sets the quality, of shadows too. @param {string} level */
    set(level) {
      sharpen(sun, level === "high" ? 2048 : 1024);
      sun.castShadow = level === "high" || level === "medium";
      const on = level === "draft";
      if (on === this.on) return;
      this.on = on;
      if (on) draft ??= make();
      draft.show(on);
    },
    /** Moves the draft after the parts. */
    follow() {
      if (!this.on) return;
      light.aLeast.value = leastOf(view.renderer.domElement.height);
      draft.follow();
    },
    dispose() {
      draft?.dispose();
    },
  };
}
