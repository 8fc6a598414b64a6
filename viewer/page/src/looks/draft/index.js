// The draft quality: one call for what moves, no shadow map, ground lit at its points; for machines without a card.
import { baked } from "./baked_solids.js";
import { lightOf } from "./vertex_lighting.js";
import { leastOf } from "./tubes.js";

/**
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
    /** @param {string} level */
    set(level) {
      sun.castShadow = level === "high" || level === "medium";
      const on = level === "draft";
      if (on === this.on) return;
      this.on = on;
      if (on) draft ??= make();
      draft.show(on);
    },
    /** After the parts have their places. */
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
