// What a world is made of: asphalt, grass, wet, gravel, concrete, ice and paint, drawn by noise at several scales.
import * as THREE from "three";
import { dot } from "../scene/math.js";
import { prelit } from "./draft/prelit.js";
import { lift, PAINT, widen } from "./lifted.js";
import { tonesTexture } from "./noise.js";
import { COLOURS, CREASE, DRAFT, GLOSS, HEAD, MIRROR, NOISE, RELIEF, TONES } from "./surface_code.js";
import { atEachPixel, onTheEarth } from "./vertex_code.js";

/** Share of the distance by which paint is drawn nearer in a draft, whose ground is coarser. */
const DRAFTED = 0.01;
/** Metres after which each layer of noise repeats; none is a multiple of another. */
export const LAYERS = [1.3, 8.9, 61, 273];

/**
 * The materials of a world; `follow(origin)` keeps their pattern on the earth.
 * @param {object} options
 * @param {THREE.Texture} options.noise
 * @param {number[][]} options.axes x and y of the world, unit vectors
 * @param {THREE.Vector3} options.sun unit vector to the sun
 * @param {{textures: THREE.DataTexture[], size: number[], start: number[]}} options.cover
 * @param {number[]} options.corner x and y of the first point of the raster
 * @param {boolean} options.fine with relief and mirrored light; otherwise lit the cheapest way
 */
export function surfaceMaterials({ noise, axes, sun, cover, corner, fine }) {
  const uniforms = {
    aX: { value: new THREE.Vector3(...axes[0]) },
    aY: { value: new THREE.Vector3(...axes[1]) },
    aOffset: { value: LAYERS.map(() => new THREE.Vector2()) },
    aTones: { value: new THREE.Vector2() },
    aSpot: { value: new THREE.Vector2() },
    aNoise: { value: noise },
    aPatches: { value: null },
    aCoverA: { value: cover.textures[0] },
    aCoverB: { value: cover.textures[1] ?? null },
    aCover: { value: new THREE.Vector4(...cover.start, ...cover.size) },
    aSun: { value: sun },
    aSky: { value: null },
  };
  const viewport = { value: new THREE.Vector2(1, 1) };
  const shared = { uniforms, fine, second: cover.textures.length > 1, viewport };
  return {
    /** Of the terrain itself. */
    ground: surfaceMaterial(shared, false),
    /** Of what is painted on it: the colour is an attribute. */
    paint: surfaceMaterial(shared, true),
    /** The same, lit at their points only. @param {Data} light of `lightOf` */
    drafted(light) {
      uniforms.aPatches.value ??= tonesTexture();
      return { ground: draftMaterial(shared, light, false), paint: draftMaterial(shared, light, true) };
    },
    /** @param {THREE.Texture} texture cube of the sky, which wet places mirror */
    mirror(texture) {
      uniforms.aSky.value = texture;
    },
    /** @param {number[]} origin earth position of the picture's origin @param {THREE.Vector2} pixels of the picture */
    follow(origin, pixels) {
      viewport.value.copy(pixels);
      const [a, b] = axes.map((axis) => dot(origin, axis));
      LAYERS.forEach((period, i) => uniforms.aOffset.value[i].set(modulo(a, period), modulo(b, period)));
      uniforms.aTones.value.set(modulo(a, TONES), modulo(b, TONES));
      uniforms.aSpot.value.set(a - corner[0], b - corner[1]);
    },
  };
}

const modulo = (a, period) => a - period * Math.floor(a / period);

function surfaceMaterial({ uniforms, fine, second, viewport }, painted) {
  const settings = settingsOf(painted);
  const material = fine ? new THREE.MeshStandardMaterial({ metalness: 0, ...settings }) : new THREE.MeshLambertMaterial(settings);
  material.defines = { ...material.defines, ...(painted ? { A_PAINTED: 1 } : {}), ...(second ? { A_SECOND: 1 } : {}) };
  material.customProgramCacheKey = () => `ali3-surface-${painted}-${second}-${fine}`;
  material.onBeforeCompile = (shader) => {
    onGround(shader, uniforms, painted && viewport);
    const pieces = { color_fragment: layered(NOISE) + COLOURS, normal_fragment_begin: CREASE, lights_fragment_end: MIRROR };
    if (fine) Object.assign(pieces, { roughnessmap_fragment: GLOSS, normal_fragment_maps: layered(RELIEF) });
    atEachPixel(shader, fine ? HEAD : `#define A_COARSE\n${HEAD}`, pieces);
  };
  return material;
}

const settingsOf = (painted) => (painted ? { vertexColors: true, transparent: true, depthWrite: false } : {});

/** Noise at the places of its layers. @param {string} code */
const layered = (code) => code.replace(/LAYER_(\d)/g, (_, k) => `(plane + aOffset[${k}]) / ${LAYERS[k].toFixed(1)}`);

/** The place on the ground goes along; paint is widened and lifted. @param {Data} shader @param {Data} uniforms @param {{value: Data} | false} viewport of paint @param {number} [nearer] */
function onGround(shader, uniforms, viewport, nearer = PAINT) {
  Object.assign(shader.uniforms, uniforms);
  onTheEarth(shader);
  if (!viewport) return;
  widen(shader, viewport);
  lift(shader, nearer);
}

function draftMaterial({ uniforms, second, viewport }, light, painted) {
  return prelit(light, settingsOf(painted), `surface ${painted} ${second}`, (shader) => {
    onGround(shader, uniforms, painted && viewport, DRAFTED);
    const defines = `#define A_COARSE\n${painted ? "#define A_PAINTED\n" : ""}${second ? "#define A_SECOND\n" : ""}`;
    atEachPixel(shader, defines + HEAD, { color_fragment: layered(DRAFT) });
  });
}
