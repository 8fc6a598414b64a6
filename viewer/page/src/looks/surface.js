// Makes the materials of a world: surfaces and paint, drawn by noise at several scales.
import * as THREE from "three";
import { dot, modulo } from "../scene/math.js";
import { vertexLit } from "./draft/vertex_lighting.js";
import { lift, PAINT, widen } from "./ground_offset.js";
import { oneLevel, tonesTexture } from "./noise.js";
import { COLOURS, CREASE, DRAFT, DRAFT_HEAD, DRAFT_PLACES, DRAFT_POINT_HEAD, GLOSS, HEAD, MIRROR, NOISE, RELIEF, TONES } from "./surface_code.js";
import { atEachPixel, atEachPoint, onTheEarth } from "./vertex_code.js";

/** Depth offset of paint in a draft, whose ground is coarser, as a share of the distance. */
const DRAFT_PAINT = 0.01;
/** Periods of the layers of noise, none a multiple of another, m. */
const LAYERS = [1.3, 8.9, 61, 273];

/**
 * Makes the materials; `follow(origin)` keeps their pattern fixed to the earth.
 * @param {object} options
 * @param {THREE.Texture} options.noise
 * @param {number[][]} options.axes x and y of the world, unit vectors
 * @param {THREE.Vector3} options.sun unit vector to the sun
 * @param {{texture: THREE.DataTexture, size: number[], start: number[]}} options.cover
 * @param {number[]} options.corner x and y of the first point of the raster
 * @param {boolean} options.fine with relief and reflections, else the least expensive lighting
 */
export function surfaceMaterials({ noise, axes, sun, cover, corner, fine }) {
  const uniforms = {
    aX: { value: new THREE.Vector3(...axes[0]) },
    aY: { value: new THREE.Vector3(...axes[1]) },
    aOffset: { value: LAYERS.map(() => new THREE.Vector2()) },
    aTones: { value: new THREE.Vector2() },
    aSpot: { value: new THREE.Vector2() },
    aNoise: { value: noise },
    aShares: { value: cover.texture },
    aCover: { value: new THREE.Vector4(...cover.start, ...cover.size) },
    aSun: { value: sun },
    aSky: { value: null },
  };
  const viewport = { value: new THREE.Vector2(1, 1) };
  const shared = { uniforms, fine, viewport };
  return {
    /** Material of the terrain. */
    ground: surfaceMaterial(shared, false),
    /** Material of paint, whose colour is an attribute. */
    paint: surfaceMaterial(shared, true),
    /** The same with lighting at points. @param {Data} light of `lightOf` */
    drafted(light) {
      const [aNoise, aShares] = [noise, cover.texture].map((texture) => ({ value: oneLevel(texture) }));
      const draft = { ...shared, uniforms: { ...uniforms, aNoise, aShares, aPatches: { value: tonesTexture() } } };
      return { ground: draftMaterial(draft, light, false), paint: draftMaterial(draft, light, true) };
    },
    /** @param {THREE.Texture} texture cube of the sky, which wet ground reflects */
    mirror(texture) {
      uniforms.aSky.value = texture;
    },
    /** @param {number[]} origin earth position of the origin of the picture, m @param {THREE.Vector2} pixels size of the picture */
    follow(origin, pixels) {
      viewport.value.copy(pixels);
      const [a, b] = axes.map((axis) => dot(origin, axis));
      LAYERS.forEach((period, i) => uniforms.aOffset.value[i].set(modulo(a, period), modulo(b, period)));
      uniforms.aTones.value.set(modulo(a, TONES), modulo(b, TONES));
      uniforms.aSpot.value.set(a - corner[0], b - corner[1]);
    },
  };
}

function surfaceMaterial({ uniforms, fine, viewport }, painted) {
  const settings = settingsOf(painted);
  const material = fine ? new THREE.MeshStandardMaterial({ metalness: 0, ...settings }) : new THREE.MeshLambertMaterial(settings);
  if (painted) material.defines = { ...material.defines, A_PAINTED: 1 };
  material.customProgramCacheKey = () => `ali3-surface-${painted}-${fine}`;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    onTheEarth(shader);
    if (painted) addPaint(shader, viewport, PAINT);
    const pieces = { color_fragment: layered(NOISE) + COLOURS, normal_fragment_begin: CREASE, lights_fragment_end: MIRROR };
    if (fine) Object.assign(pieces, { roughnessmap_fragment: GLOSS, normal_fragment_maps: layered(RELIEF) });
    atEachPixel(shader, fine ? HEAD : `#define A_COARSE\n${HEAD}`, pieces);
  };
  return material;
}

const settingsOf = (painted) => (painted ? { vertexColors: true, transparent: true, depthWrite: false } : {});

/** Code with the texture coordinates of the layers. @param {string} code */
const layered = (code) => code.replace(/LAYER_(\d)/g, (_, k) => `(plane + aOffset[${k}]) / ${LAYERS[k].toFixed(1)}`);

/** Widens and offsets paint in a shader. @param {Data} shader @param {{value: Data}} viewport @param {number} nearer */
function addPaint(shader, viewport, nearer) {
  widen(shader, viewport);
  lift(shader, nearer);
}

function draftMaterial({ uniforms, viewport }, light, painted) {
  return vertexLit(light, settingsOf(painted), `surface ${painted}`, (shader) => {
    Object.assign(shader.uniforms, uniforms);
    atEachPoint(shader, DRAFT_POINT_HEAD, layered(DRAFT_PLACES));
    if (painted) addPaint(shader, viewport, DRAFT_PAINT);
    atEachPixel(shader, (painted ? "#define A_PAINTED\n" : "") + DRAFT_HEAD, { color_fragment: DRAFT });
  });
}
