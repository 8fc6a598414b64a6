// Flexible bodies: tubes that bend with the amplitudes of modes, coloured by stress.
import * as THREE from "three";
import { colourTexture } from "../looks/colour_map.js";
import { growing } from "../looks/draft/tubes.js";
import { headlight } from "../looks/headlight.js";
import { Bending } from "../scene/bending.js";
import { FrameTubes } from "./frame_tubes.js";

/** The drawing of an entry of `flexible` of a scene. */
export class Flexible {
  /**
   * @param {Data} body
   * @param {import("../looks/materials.js").Materials} materials
   * @param {number} [thinnest] least drawn radius of tubes, m
   */
  constructor(body, materials, thinnest = 0) {
    this.frame = body.frame;
    this.name = body.name ?? body.frame;
    this.bending = new Bending(body);
    this.tubes = new FrameTubes(body.nodes, body.beams, (body.radii ?? []).map((r) => Math.max(r, thinnest)));
    this.plain = materials.get("steel");
    this.map = colourTexture();
    this.coloured = headlight({ map: this.map });
    /** Least radius of tubes in a draft, else 0, see `growing`. */
    this.least = { value: 0 };
    this.coloured.onBeforeCompile = (shader) => growing(shader, this.least);
    this.coloured.customProgramCacheKey = () => "ali3-stress";
    this.object = new THREE.Mesh(this.tubes.geometry, this.plain);
    this.object.frustumCulled = false;
    this.object.userData.alone = true; // its form changes
    this.object.userData.coarse = this.tubes.coarse; // triangles for drafts
    this.colours = !materials.options.ghost;
    this.absent = "";
    this.update(null, 1);
    this.paint(false, 1);
  }

  /** Whether the stress is known. */
  get stressed() {
    return this.bending.stress !== null && this.absent === "";
  }

  /** Largest stress; 0 if it is not known. */
  get most() {
    return this.stressed ? this.bending.stress.reduce((a, b) => Math.max(a, b), 0) : 0;
  }

  /** @param {((name: string) => number | undefined) | null} lookup @param {number} factor of the displacement @returns {string} a sentence if values are missing */
  update(lookup, factor) {
    this.absent = this.bending.update(lookup, factor);
    this.moved = true;
    if (this.absent === "") return "";
    const name = this.name;
    if (this.absent === null) return `Deformation and stresses of '${name}' are not computed where the column '${this.bending.computed}' is 0.`;
    return `Deformation and stresses of '${name}' are not drawn where the column '${this.absent}' has no number.`;
  }

  /** Updates points and colours. @param {boolean} coloursOfStress @param {number} most stress of the last colour */
  paint(coloursOfStress, most) {
    if (this.moved) this.tubes.move(this.bending.displaced);
    this.moved = false;
    const coloured = coloursOfStress && this.colours && this.stressed;
    this.object.material = coloured ? this.coloured : this.plain;
    if (coloured) this.tubes.colour(this.bending.stress, most);
  }

  dispose() {
    this.map.dispose();
    this.coloured.dispose();
  }
}
