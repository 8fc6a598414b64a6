// Material of roads and ground, whose pattern is fixed to the earth while the origin of the picture follows the focus.
import * as THREE from "three";
import { cross, dot, modulo, sideways } from "../scene/math.js";
import { vertexLit } from "./draft/vertex_lighting.js";
import { oneLevel } from "./noise.js";
import { SKYLIGHT } from "./skylight.js";
import { atEachPixel, atEachPoint, onTheEarth } from "./vertex_code.js";

/** Periods of the layers of the pattern, m: grain, patches, tones, painted lines. */
const PERIODS = [1.1, 7.3, 61, 10];
/** Linear colour of grass. */
const GRASS = new THREE.Color(0.105, 0.125, 0.052);

const PARAMETERS = /* glsl */ `
uniform vec3 aX, aY;
uniform vec2 aOffset[4];
uniform sampler2D aNoise;
uniform float aPaint;
uniform vec3 aGrass;
varying vec3 vGround;
varying vec2 vSlick;
`;

/** Linear colours of the ground. */
const COLOURS = /* glsl */ `
const vec3 STONE = vec3(0.118, 0.119, 0.12), PAINT = vec3(0.62), ICE = vec3(0.55, 0.66, 0.74), PAVING = vec3(0.46, 0.455, 0.44);
const float SPECK = 0.09; // of bright stones, added
const float WET = 0.58; // share of the light that a film of water takes
const float HALF_LINE = 0.06; // half the width of a painted line, m
`;

/** Colour: grain, patches and tones of the noise; painted lines; vSlick: film of water (-1: stone) and ice. */
const ASPHALT = /* glsl */ `
vec2 plane = vec2(dot(vGround, aX), dot(vGround, aY));
vec4 near = texture2D(aNoise, (plane + aOffset[0]) / ${PERIODS[0].toFixed(1)});
float grain = near.r;
float speck = near.a;
float patches = texture2D(aNoise, (plane + aOffset[1]) / ${PERIODS[1].toFixed(1)}).g;
float tone = texture2D(aNoise, (plane + aOffset[2]) / ${PERIODS[2].toFixed(1)}).b;
vec3 stone = STONE * (0.3 + 1.05 * grain + 0.45 * (patches - 0.5) + 0.6 * (tone - 0.5)) + SPECK * speck;
#ifdef A_GRASS
stone = aGrass * (0.35 + 0.75 * grain * patches + 1.1 * (tone - 0.3));
#endif
if (aPaint > 0.0) {
  vec2 line = abs(mod(plane + aOffset[3] + ${(PERIODS[3] / 2).toFixed(1)}, ${PERIODS[3].toFixed(1)}) - ${(PERIODS[3] / 2).toFixed(1)});
  vec2 soft = max(fwidth(plane), 1e-5);
  vec2 on = 1.0 - smoothstep(HALF_LINE - 0.5 * soft, HALF_LINE + 0.5 * soft + 1e-4, line);
  on *= min(vec2(1.0), 2.0 * HALF_LINE / soft);
  stone = mix(stone, PAINT * (0.75 + 0.3 * patches), aPaint * max(on.x, on.y) * (0.55 + 0.45 * grain));
}
vec3 ice = ICE * (0.8 + 0.3 * patches);
stone = mix(stone, PAVING * (0.7 + 0.45 * grain), clamp(-vSlick.x, 0.0, 1.0));
float film = max(vSlick.x, 0.0);
stone = mix(stone * (1.0 - WET * film), ice, vSlick.y);
diffuseColor.rgb *= stone;
`;

/** Gloss: wet ground reflects the sky. */
const ROUGHNESS = /* glsl */ `
float wetGloss = smoothstep(0.3, 1.2, film + vSlick.y);
roughnessFactor = mix(0.86 + 0.12 * patches - 0.1 * speck, 0.16 + 0.12 * patches, wetGloss);
`;

/** Relief of the grain, where it is near enough to be visible. */
const RELIEF = /* glsl */ `
float fade = clamp(1.0 - 60.0 * max(fwidth(plane.x), fwidth(plane.y)), 0.0, 1.0);
if (fade > 0.0) {
  vec2 at = (plane + aOffset[0]) / ${PERIODS[0].toFixed(1)};
  float e = 1.0 / 256.0;
  vec2 slope = vec2(texture2D(aNoise, at + vec2(e, 0.0)).r - grain, texture2D(aNoise, at + vec2(0.0, e)).r - grain);
  vec3 tilt = (viewMatrix * vec4(aX * slope.x + aY * slope.y, 0.0)).xyz;
  normal = normalize(normal - fade * (1.0 - 0.5 * (film + vSlick.y)) * 0.55 * tilt);
}
`;

/**
 * Makes the material; `follow(origin)` keeps its pattern fixed to the earth.
 * @param {{noise: THREE.Texture, up: number[], paint?: number, grass?: boolean, fine?: boolean}} options
 *   fine: with relief and gloss, else the least expensive lighting
 */
export function groundMaterial({ noise, up, paint = 0, grass = false, fine = false }) {
  const x = sideways(up);
  const y = cross(up, x);
  const uniforms = {
    aX: { value: new THREE.Vector3(...x) },
    aY: { value: new THREE.Vector3(...y) },
    aOffset: { value: PERIODS.map(() => new THREE.Vector2()) },
    aNoise: { value: noise },
    aPaint: { value: paint },
    aGrass: { value: GRASS },
  };
  const material = fine ? new THREE.MeshStandardMaterial({ metalness: 0 }) : new THREE.MeshLambertMaterial();
  material.defines = { ...material.defines, ...(grass ? { A_GRASS: 1 } : {}) };
  material.customProgramCacheKey = () => `ali3-ground-${grass}-${fine}`;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    addPattern(shader);
    atEachPixel(shader, "", fine ? { roughnessmap_fragment: ROUGHNESS, normal_fragment_maps: RELIEF } : { lights_fragment_end: SKYLIGHT });
  };
  /** The same pattern with lighting at points. @param {Data} light of `lightOf` */
  const drafted = (light) =>
    vertexLit(light, {}, `ground ${grass}`, (shader) => {
      Object.assign(shader.uniforms, uniforms, { aNoise: { value: oneLevel(noise) } });
      addPattern(shader);
      if (grass) atEachPixel(shader, "#define A_GRASS", {});
    });
  /** @param {number[]} origin earth position of the origin of the picture, m */
  const follow = (origin) => {
    const [a, b] = [dot(origin, x), dot(origin, y)];
    PERIODS.forEach((period, i) => uniforms.aOffset.value[i].set(modulo(a, period), modulo(b, period)));
  };
  return { material, drafted, follow };
}

/** Adds the pattern to a shader. @param {Data} shader of three.js */
function addPattern(shader) {
  onTheEarth(shader);
  atEachPoint(shader, "attribute vec2 slick;\nvarying vec2 vSlick;", "vSlick = slick;");
  atEachPixel(shader, PARAMETERS + COLOURS, { map_fragment: ASPHALT });
}
