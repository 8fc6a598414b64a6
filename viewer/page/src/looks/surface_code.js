// Shader code of surfaces, inserted into shaders of three.js.
import looks from "../../../looks.json" with { type: "json" };

/** Mean linear colour of a surface as shader code. @param {keyof typeof looks.surfaces} name */
const mean = (name) => `vec3(${looks.surfaces[name].join(", ")})`;

export const HEAD = /* glsl */ `
uniform vec3 aX, aY, aSun;
uniform vec2 aOffset[4];
uniform vec2 aSpot, aTones;
uniform vec4 aCover;
uniform sampler2D aNoise, aShares;
uniform samplerCube aSky;
varying vec3 vGround;
`;

/** Period of the tones of distant ground, a multiple of the longest layer, m. */
export const TONES = 61 * 273;

/**
 * Tones of a few pixels at any distance, because mipmaps blur layers of fixed size to their mean. The size of pixels is
 * that on level ground, because facets smaller than pixels would make it flicker. Consecutive sizes, each half of the
 * previous one, are blended so that there is no visible edge.
 */
const DETAIL = /* glsl */ `
vec3 sight = vGround - cameraPosition;
float away = length(sight);
sight /= away;
float pixel = max(length(dFdx(sight)), length(dFdy(sight)));
float reach = away * pixel / max(abs(dot(sight, cross(aX, aY))), 0.01);
float octave = clamp(log2(${TONES.toFixed(1)} / (160.0 * max(reach, 1e-4))), 0.0, 14.0);
float finer = fract(octave);
vec2 tonesAt = (plane + aTones) / ${TONES.toFixed(1)} * exp2(floor(octave));
float tones = textureLod(aNoise, tonesAt, 1.0 - finer).g;
float over = smoothstep(0.7, 1.0, finer);
if (over > 0.0) tones = mix(tones, textureLod(aNoise, 2.0 * tonesAt, 2.0 - finer).g, over);
tones -= 0.518;
float detail = 1.0 + smoothstep(0.01, 0.06, reach) * inversesqrt(1.0 - 2.0 * over * (1.0 - over)) * mix(0.4, 0.9, smoothstep(0.1, 2.0, reach)) * tones;
`;

/**
 * Shares of asphalt, grass, wet, gravel as positive values, of dirt, paint, ice, concrete as negative ones, which
 * coverage.js halves. The sum of all shares is one. If two surfaces of a channel are present, the missing sum is 1.5 times
 * the lesser share; so `upper` distinguishes a quarter of one surface from halves of both. A bias to finer mipmaps
 * replaces anisotropic filtering of roads at flat angles.
 * @param {string} at texture coordinates @param {string} sharper bias
 */
const sharesAt = (at, sharper) => `vec4 code = (texture2D(aShares, ${at}, ${sharper}) * 255.0 - 128.0) / 127.0;
vec4 one = max(code, 0.0);
float missing = max(1.0 - dot(one - 2.0 * min(code, 0.0), vec4(1.0)), 0.0);
vec4 upper = smoothstep(0.4, 0.6, (code + missing / 3.0) / max(one + missing, 1e-3));
code = min(code, 2.0 * code);`;

/** Texture coordinates of the shares. */
const PLACE = "vec2 at = ((spot - aCover.yx) / aCover.wz).yx;";

/** Noise at four scales, and shares of the surfaces with edges sharpened by noise. */
export const NOISE = /* glsl */ `
vec2 plane = vec2(dot(vGround, aX), dot(vGround, aY));
vec4 near = texture2D(aNoise, LAYER_0);
vec4 some = texture2D(aNoise, LAYER_1);
vec4 wide = texture2D(aNoise, LAYER_2);
vec4 far = texture2D(aNoise, LAYER_3);
vec2 spot = plane + aSpot;
${PLACE}
#ifdef A_COARSE
${sharesAt("at", "-2.0")}
#else
${sharesAt("at", "-0.5")}
#endif
float ragged = 0.7 * some.g + 0.3 * near.r - 0.5;
code *= 1.0 + ragged * mix(vec4(0.7, 0.0, 0.0, 0.0), vec4(0.0, 0.9, 0.0, -0.9), upper);
code *= code; code *= code; code *= code;
code.x += 1e-30;
code /= dot(code, vec4(1.0));
vec4 lower = code - code * upper;
vec4 first = vec4((code - lower).yzw, lower.w);
vec3 second = lower.zyx;
float rest = code.x - lower.x;
`;

/** Linear colours of all surfaces, mixed by their shares. */
export const COLOURS = /* glsl */ `
float tar = 0.86 + 0.34 * (some.g - 0.5) + 0.5 * (wide.b - 0.5) + 0.3 * (far.g - 0.5);
vec3 asphalt = vec3(0.108, 0.109, 0.111) * tar * (0.42 + 1.0 * near.r) + 0.07 * near.a;
float turf = 0.55 * wide.b + 0.45 * far.g;
vec3 grass = mix(vec3(0.045, 0.088, 0.018), vec3(0.15, 0.15, 0.045), smoothstep(0.36, 0.66, turf + 0.3 * (some.b - 0.5)));
grass *= (0.35 + 0.95 * near.r * (0.6 + 0.8 * near.g)) * (0.62 + 0.8 * some.g);
vec3 stones = mix(vec3(0.20, 0.175, 0.145), vec3(0.34, 0.32, 0.29), some.b) * (0.25 + 0.8 * near.r * near.r + 0.55 * near.g) * (0.7 + 0.6 * wide.g);
vec2 joint = abs(mod(spot + 2.5, 5.0) - 2.5);
float gap = max(fwidth(spot.x), fwidth(spot.y));
float seam = (1.0 - smoothstep(0.012, 0.012 + gap, min(joint.x, joint.y))) * min(1.0, 0.024 / max(gap, 1e-4));
vec3 concrete = vec3(0.36, 0.352, 0.33) * (0.72 + 0.2 * near.r + 0.3 * (some.g - 0.5) + 0.3 * (wide.b - 0.5)) * (1.0 - 0.55 * seam);
float film = clamp(0.42 + 1.6 * (some.g - 0.42) + 0.9 * (wide.b - 0.45), 0.0, 1.0);
vec3 soaked = asphalt * mix(0.5, 0.24, film) + vec3(0.0, 0.002, 0.004);
vec3 ice = mix(vec3(0.42, 0.53, 0.6), vec3(0.72, 0.78, 0.82), smoothstep(0.3, 0.7, 0.6 * some.g + 0.4 * wide.b)) * (0.88 + 0.2 * near.g);
vec3 soil = mix(vec3(0.115, 0.078, 0.046), vec3(0.19, 0.14, 0.09), smoothstep(0.3, 0.7, wide.b)) * (0.5 + 0.5 * near.r + 0.5 * some.g);
vec3 white = vec3(0.62, 0.62, 0.6) * (0.72 + 0.24 * near.r + 0.2 * some.g);
#ifdef A_PAINTED
float worn = smoothstep(0.74, 0.93, near.r * (0.5 + 0.75 * some.g + 0.15 * wide.g));
diffuseColor.rgb *= mix(0.78 + 0.16 * near.r + 0.18 * some.g, 0.3, worn) * (1.0 - 0.35 * first.y);
#else
diffuseColor.rgb *= rest * asphalt + first.x * grass + first.y * soaked + first.z * stones + first.w * concrete + second.x * ice + second.y * white + second.z * soil;
${DETAIL}
diffuseColor.rgb *= mix(detail, 1.0, first.y); // water hides them
#endif
float wetness = first.y * (0.35 + 0.65 * film);
float slick = wetness + 0.55 * second.x;
`;

/** Texture coordinates of a draft; code for each point. */
export const DRAFT_PLACES = /* glsl */ `
vec3 earth = (modelMatrix * vec4(position, 1.0)).xyz;
vec2 plane = vec2(dot(earth, aX), dot(earth, aY));
vec2 spot = plane + aSpot;
${PLACE}
vGrain = LAYER_0;
vTone = LAYER_2;
vShares = at;`;
const DRAFT_VARYING = "varying vec2 vGrain, vTone, vShares;\n";
export const DRAFT_POINT_HEAD = `${DRAFT_VARYING}uniform vec3 aX, aY;\nuniform vec2 aOffset[4], aSpot;\nuniform vec4 aCover;`;
export const DRAFT_HEAD = `${DRAFT_VARYING}uniform sampler2D aNoise, aPatches, aShares;\n`;

/** Colours of drafts from grain and one tone, with the same mean colours. */
export const DRAFT = /* glsl */ `
float grain = texture2D(aNoise, vGrain).r;
float tone = texture2D(aPatches, vTone).r;
${sharesAt("vShares", "-2.0")}
vec4 both = code * code;
both *= both; both *= both;
both.x += 1e-30;
vec4 ones = both * upper;
vec4 others = both - ones;
#ifdef A_PAINTED
diffuseColor.rgb *= 0.72 + 0.3 * grain;
#else
vec3 mean = ones.x * ${mean("asphalt")} + ones.y * ${mean("grass")} * mix(vec3(0.57, 0.785, 0.67), vec3(1.43, 1.215, 1.33), tone);
mean += ones.z * ${mean("wet")} + ones.w * ${mean("gravel")} + others.w * ${mean("concrete")};
mean += others.z * ${mean("ice")} + others.y * ${mean("paint")} + others.x * ${mean("dirt")};
diffuseColor.rgb *= (0.325 + 0.55 * grain + 0.85 * tone) * mean / dot(both, vec4(1.0));
#endif
`;

/** Gloss: water and ice reflect the sky. */
export const GLOSS = /* glsl */ `
roughnessFactor = mix(0.9 + 0.08 * some.g, 0.1 + 0.2 * (1.0 - film), min(1.0, slick));
`;

/** Keeps sharp edges, such as those of kerbs, sharp; skirts, perpendicular to their normals, stay unchanged. */
export const CREASE = /* glsl */ `
vec3 facet = normalize(cross(dFdx(vViewPosition), dFdy(vViewPosition)));
float bend = dot(facet, normal);
normal = normalize(mix(normal, facet, smoothstep(0.97, 0.9, bend) * smoothstep(0.1, 0.3, bend)));
`;

/** Relief of the grain, where it is near enough to be visible. */
export const RELIEF = /* glsl */ `
float fade = clamp(1.0 - 45.0 * max(fwidth(plane.x), fwidth(plane.y)), 0.0, 1.0);
if (fade > 0.0) {
  float e = 1.0 / 256.0;
  vec2 here = LAYER_0;
  vec2 tilt = vec2(texture2D(aNoise, here + vec2(e, 0.0)).r, texture2D(aNoise, here + vec2(0.0, e)).r) - near.r;
  float rough = 0.5 * rest + 0.9 * first.x + 0.9 * first.z + 0.2 * first.w + 0.7 * second.z;
  normal = normalize(normal - fade * rough * (viewMatrix * vec4(aX * tilt.x + aY * tilt.y, 0.0)).xyz);
}
`;

/** Light of the sky without reflections in materials: diffuse light, and reflections on wet ground. */
export const MIRROR = /* glsl */ `
#ifdef A_COARSE
reflectedLight.indirectDiffuse += vec3(0.34, 0.39, 0.47) * diffuseColor.rgb;
if (slick > 0.02) {
  vec3 eye = normalize(vViewPosition);
  vec3 bent = normalize(normal);
  float facing = clamp(dot(eye, bent), 0.0, 1.0);
  float share = slick * (0.03 + 0.97 * pow(1.0 - facing, 5.0));
  vec3 way = normalize((vec4(reflect(-eye, bent), 0.0) * viewMatrix).xyz);
  vec3 seen = min(textureCube(aSky, way).rgb, vec3(2.5));
  reflectedLight.indirectDiffuse += share * seen + slick * 4.0 * pow(max(dot(way, aSun), 0.0), 300.0);
}
#endif
`;
