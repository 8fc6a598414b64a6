// Physically based materials by name, shared by all shapes with the same look and colour.
import * as THREE from "three";
import looks from "../../../looks.json" with { type: "json" };

/** @type {Object<string, Data>} */
const KINDS = looks.materials;

/** Opacities of covers when parts inside are shown. */
const OPEN_OPACITY = { panel: 0.3, glass: 0.18 };
const GHOST_OPACITY = 0.5;
/** Factor of the opacity of glass for cameras inside. */
const INSIDE_FACTOR = 0.3;

/** Makes and stores the materials of a scene. */
export class Materials {
  _materials = new Map();
  /** Opacities of covers by material: closed and open. */
  _covers = new Map();

  /**
   * @param {{ghost?: boolean, tint?: string}} [options] ghost: a further recording, drawn transparent
   *   and in the colour `tint`
   */
  constructor(options = {}) {
    this.options = options;
  }

  /**
   * The material of a shape.
   * @param {{material?: string, color?: string, opacity?: number, cover?: boolean}} shape a cover hides parts inside
   * @param {string} [defaultKind] kind of material if the shape has none
   * @param {{doubleSided?: boolean}} [sides] visible from both sides
   * @returns {THREE.Material}
   */
  forShape(shape, defaultKind = "plastic", { doubleSided = false } = {}) {
    const kind = KINDS[shape.material] ? shape.material : defaultKind;
    const { color, opacity, cover } = shape;
    return this.get(kind, { color, opacity, doubleSided, cover });
  }

  /**
   * The material of a kind, by default with the colour and opacity of the kind.
   * @param {string} kind
   * @param {{color?: string, opacity?: number, doubleSided?: boolean, cover?: boolean}} [options]
   * @returns {THREE.Material}
   */
  get(kind, { color, opacity, doubleSided = false, cover = false } = {}) {
    const key = [kind, color, opacity, doubleSided, cover].join("|");
    if (!this._materials.has(key)) this._materials.set(key, this._make(kind, { color, opacity, doubleSided, cover }));
    return this._materials.get(key);
  }

  /** Makes a material. @param {string} kind @param {Data} options see `get` @returns {THREE.Material} */
  _make(kind, { color, opacity, doubleSided, cover }) {
    const { ghost, tint } = this.options;
    const { opacity: defaultOpacity = 1, clearcoat, clearcoatRoughness, ...look } = KINDS[kind];
    if (ghost) Object.assign(look, { color: tint ?? looks.ghosts[0], metalness: 0, roughness: 0.9 });
    else if (color) look.color = color;
    const closedOpacity = (ghost ? GHOST_OPACITY : 1) * (opacity ?? defaultOpacity);
    const coated = clearcoat && !ghost;
    const material = coated ? new THREE.MeshPhysicalMaterial({ ...look, clearcoat, clearcoatRoughness }) : new THREE.MeshStandardMaterial(look);
    material.name = kind;
    material.side = doubleSided ? THREE.DoubleSide : THREE.FrontSide;
    if (cover) this._covers.set(material, { closed: closedOpacity, open: OPEN_OPACITY[kind] ?? OPEN_OPACITY.panel });
    if (closedOpacity < 1) Object.assign(material, { transparent: true, opacity: closedOpacity, depthWrite: false });
    return material;
  }

  /** Whether there are covers. */
  get hasCovers() {
    return this._covers.size > 0;
  }

  /** Makes covers solid or transparent. @param {boolean} isClosed */
  setCoversClosed(isClosed) {
    for (const [material, { closed, open }] of this._covers) {
      const opacity = isClosed ? closed : open;
      Object.assign(material, { opacity, transparent: opacity < 1, depthWrite: opacity === 1, needsUpdate: true });
      delete material.userData.opacity; // `setCameraInside` stores it anew
    }
  }

  /** Makes glass more transparent for cameras inside. @param {boolean} isInside */
  setCameraInside(isInside) {
    for (const material of this._materials.values()) {
      if (material.name !== "glass") continue;
      material.userData.opacity ??= material.opacity;
      material.opacity = material.userData.opacity * (isInside ? INSIDE_FACTOR : 1);
    }
  }

  /** Frees the materials on the graphics card. */
  dispose() {
    for (const material of this._materials.values()) material.dispose();
    this._materials.clear();
    this._covers.clear();
  }
}
