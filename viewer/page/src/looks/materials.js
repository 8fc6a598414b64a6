// Physically based materials by name, shared by all shapes with the same look and colour.
import * as THREE from "three";
import looks from "../../../looks.json" with { type: "json" };

/** @type {Object<string, Data>} */
const KINDS = looks.materials;

/** Opacities of open covers: panels, glass. */
const OPEN_OPACITIES = [0.3, 0.18];

/** Makes and stores the materials of a scene. */
export class Materials {
  _made = new Map();
  _covers = new Map();

  /** @param {{ghost?: boolean, tint?: string, opacity?: number}} [options] a ghost is transparent and has one colour */
  constructor(options = {}) {
    this.options = options;
  }

  /**
   * @param {{material?: string, color?: string, opacity?: number, cover?: boolean}} shape a cover hides parts inside
   * @param {string} [other] kind of material if the shape has none
   * @param {{double?: boolean}} [sides] visible from both sides
   */
  of(shape, other = "plastic", { double = false } = {}) {
    const kind = KINDS[shape.material] ? shape.material : other;
    return this.named(kind, shape.color, shape.opacity, double, shape.cover);
  }

  /** @param {string} kind @param {string} [color] @param {number} [opacity] @param {boolean} [double] @param {boolean} [cover] */
  named(kind, color, opacity, double = false, cover = false) {
    const { ghost, tint } = this.options;
    const key = [kind, color, opacity, double, cover].join("|");
    if (!this._made.has(key)) {
      const { opacity: own = 1, clearcoat, clearcoatRoughness, ...look } = KINDS[kind];
      if (ghost) Object.assign(look, { color: tint ?? looks.ghosts[0], metalness: 0, roughness: 0.9 });
      else if (color) look.color = color;
      const solid = ghost ? (this.options.opacity ?? 0.5) * (opacity ?? own) : (opacity ?? own);
      const coated = clearcoat && !ghost;
      const material = coated ? new THREE.MeshPhysicalMaterial({ ...look, clearcoat, clearcoatRoughness }) : new THREE.MeshStandardMaterial(look);
      material.name = kind;
      material.side = double ? THREE.DoubleSide : THREE.FrontSide;
      if (cover) this._covers.set(material, { solid, open: kind === "glass" ? OPEN_OPACITIES[1] : OPEN_OPACITIES[0] });
      if (solid < 1) Object.assign(material, { transparent: true, opacity: solid, depthWrite: false });
      this._made.set(key, material);
    }
    return this._made.get(key);
  }

  /** Whether there are covers. */
  get covered() {
    return this._covers.size > 0;
  }

  /** Makes covers solid or transparent. @param {boolean} closed */
  cover(closed) {
    for (const [material, { solid, open }] of this._covers) {
      const opacity = closed ? solid : open;
      Object.assign(material, { opacity, transparent: opacity < 1, depthWrite: opacity === 1, needsUpdate: true });
      delete material.userData.opacity;
    }
  }

  /** Makes glass more transparent for cameras inside. @param {boolean} within */
  clear(within) {
    for (const [key, material] of this._made) {
      if (!key.startsWith("glass|")) continue;
      material.userData.opacity ??= material.opacity;
      material.opacity = material.userData.opacity * (within ? 0.3 : 1);
    }
  }

  dispose() {
    for (const material of this._made.values()) material.dispose();
    this._made.clear();
    this._covers.clear();
  }
}
