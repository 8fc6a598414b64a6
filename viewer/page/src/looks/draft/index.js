// The draft quality: one call for what moves, no shadow map, ground lit at its points; for machines without a card.
import { baked } from "./baked.js";
import { blobs } from "./blobs.js";
import { lightOf } from "./prelit.js";

/**
 * @param {Data} view the SceneView
 * @param {import("three").DirectionalLight} sun
 * @param {{shadows?: boolean}} [options] shadows: blobs on the ground
 */
export function makeDraft(view, sun, { shadows = true } = {}) {
  const { world, parts, extent, up } = view;
  const light = lightOf(sun, up);
  let made = null;
  const make = () => {
    const car = baked(parts, light, extent);
    const spots = shadows ? blobs(view) : null;
    world.add(car.mesh, ...(spots ? [spots.mesh] : []));
    return { car, spots };
  };
  return {
    light,
    on: false,
    /** @param {boolean} on */
    set(on) {
      if (on === this.on) return;
      this.on = on;
      sun.castShadow = !on;
      if (on) made ??= make();
      made.car.show(on);
      if (made.spots) made.spots.mesh.visible = on;
    },
    /** After the parts have their places. @param {number[]} origin */
    follow(origin) {
      if (!this.on) return;
      made.car.follow();
      made.spots?.follow(origin);
    },
    dispose() {
      made?.car.dispose();
      made?.spots?.dispose();
    },
  };
}
