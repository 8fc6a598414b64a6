// Physically based materials by name; one object a look and colour, shared by all shapes that have it.
import * as THREE from "three";
import looks from "../../../looks.json" with { type: "json" };

/** @type {Object<string, Data>} */
const KINDS = looks.materials;

/** Makes and keeps the materials of a scene. */
export class Materials {
  #made = new Map();

  /** @param {{ghost?: boolean, tint?: string, opacity?: number}} [options] a ghost is see-through and of one tint */
  constructor(options = {}) {
    this.options = options;
  }

  /**
   * @param {{material?: string, color?: string, opacity?: number}} shape
   * @param {string} [other] kind of material where the shape names none
   * @param {{double?: boolean}} [sides] seen from both sides
   */
  of(shape, other = "plastic", { double = false } = {}) {
    const kind = KINDS[shape.material] ? shape.material : other;
    return this.named(kind, shape.color, shape.opacity, double);
  }

  /** @param {string} kind @param {string} [color] @param {number} [opacity] @param {boolean} [double] */
  named(kind, color, opacity, double = false) {
    const { ghost, tint } = this.options;
    const key = [kind, color, opacity, double].join("|");
    if (!this.#made.has(key)) {
      const { opacity: own = 1, clearcoat, clearcoatRoughness, ...look } = KINDS[kind];
      if (ghost) Object.assign(look, { color: tint ?? "#3f7fd0", metalness: 0, roughness: 0.9 });
      else if (color) look.color = color;
      const solid = ghost ? (this.options.opacity ?? 0.32) * (opacity ?? own) : (opacity ?? own);
      const coated = clearcoat && !ghost;
      const material = coated ? new THREE.MeshPhysicalMaterial({ ...look, clearcoat, clearcoatRoughness }) : new THREE.MeshStandardMaterial(look);
      material.side = double ? THREE.DoubleSide : THREE.FrontSide;
      if (solid < 1) Object.assign(material, { transparent: true, opacity: solid, depthWrite: false });
      this.#made.set(key, material);
    }
    return this.#made.get(key);
  }

  /** Through glass one sees better from within. @param {boolean} within */
  clear(within) {
    for (const [key, material] of this.#made) {
      if (!key.startsWith("glass|")) continue;
      material.userData.opacity ??= material.opacity;
      material.opacity = material.userData.opacity * (within ? 0.3 : 1);
    }
  }

  dispose() {
    for (const material of this.#made.values()) material.dispose();
    this.#made.clear();
  }
}
