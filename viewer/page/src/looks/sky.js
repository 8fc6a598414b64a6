// Makes a sky of haze, blue, sun, clouds and distant hills, which is drawn once to a cube.
import * as THREE from "three";

/** Linear colours of the sky; fog has the colour of the haze. */
export const HAZE = new THREE.Color(0.47, 0.58, 0.7);
const ZENITH = new THREE.Color(0.045, 0.16, 0.46);
const GROUND = new THREE.Color(0.2, 0.2, 0.19);
const HILL = new THREE.Color(0.12, 0.2, 0.2);

const VERTEX = /* glsl */ `
varying vec3 direction;
void main() {
  direction = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const FRAGMENT = /* glsl */ `
varying vec3 direction;
uniform vec3 up, sun, haze, zenith, ground, hill;
uniform sampler2D noise;

// Light around the sun: weights and exponents of the wide and of the narrow glow; cosines of the edge of its disc.
const vec3 GLOW = vec3(1.0, 0.82, 0.6);
const float WIDE = 0.22, WIDE_POWER = 12.0, NARROW = 0.5, NARROW_POWER = 220.0;
const vec3 DISC = vec3(1.0, 0.95, 0.86);
const float DISC_LIGHT = 40.0, DISC_OUTER = 0.99985, DISC_INNER = 0.99993;
// Clouds on a plane above: periods of the noise and offsets, limits of the noise, and sines of the heights over the
// horizon between which they appear; share of the sky that they hide.
const vec3 CLOUD = vec3(1.0, 0.99, 0.97);
const float CLOUD_SCALE = 0.085, CLOUD_SHIFT = 0.3, CLOUD_LEAST = 0.52, CLOUD_MOST = 0.72;
const float CLOUD_LOW = 0.03, CLOUD_HIGH = 0.22, CLOUD_OPACITY = 0.8;
const float SHADE_SCALE = 0.23, SHADE_SHIFT = 0.5, SHADE_LEAST = 0.72, SHADE_RANGE = 0.4;
// Two ranges of hills: sines of their least height and of its variation, and share of their colour in the haze.
const float FAR_LEAST = 0.012, FAR_RANGE = 0.034, FAR_SCALE = 0.31, FAR_SHIFT = 0.9, FAR_COLOUR = 0.42;
const float NEAR_LEAST = 0.003, NEAR_RANGE = 0.022, NEAR_SCALE = 0.73, NEAR_SHIFT = 0.31, NEAR_COLOUR = 0.7;
// Half the width of the soft edge of hills and of the horizon, and the sine of depth at which the ground has its colour.
const float HILL_EDGE = 0.0015, HORIZON_EDGE = 0.001, GROUND_DEPTH = 0.25;

// Noise of two octaves, 0 to 1.
float octaves(vec2 p) { return 0.7 * texture2D(noise, p).b + 0.3 * texture2D(noise, p * 5.3 + 0.37).g; }

void main() {
  vec3 d = normalize(direction);
  // horizontal axes, height (sine) and cosine of the angle to the sun
  vec3 x = normalize(abs(up.x) < 0.9 ? cross(up, vec3(1, 0, 0)) : cross(up, vec3(0, 1, 0)));
  vec3 y = cross(up, x);
  float h = dot(d, up);
  float s = max(dot(d, sun), 0.0);
  vec3 sky = mix(haze, zenith, pow(clamp(h, 0.0, 1.0), 0.5));
  sky += GLOW * (WIDE * pow(s, WIDE_POWER) + NARROW * pow(s, NARROW_POWER));
  vec2 high = vec2(dot(d, x), dot(d, y)) / max(h, 0.02);
  float cloud = smoothstep(CLOUD_LEAST, CLOUD_MOST, octaves(high * CLOUD_SCALE + CLOUD_SHIFT)) * smoothstep(CLOUD_LOW, CLOUD_HIGH, h);
  float lit = SHADE_LEAST + SHADE_RANGE * octaves(high * SHADE_SCALE - SHADE_SHIFT);
  sky = mix(sky, CLOUD * lit, CLOUD_OPACITY * cloud);
  sky += DISC * DISC_LIGHT * smoothstep(DISC_OUTER, DISC_INNER, s) * (1.0 - cloud);
  float around = atan(dot(d, y), dot(d, x));
  vec2 ring = vec2(cos(around), sin(around));
  float far = FAR_LEAST + FAR_RANGE * octaves(ring * FAR_SCALE + FAR_SHIFT);
  float near = NEAR_LEAST + NEAR_RANGE * octaves(ring * NEAR_SCALE + NEAR_SHIFT);
  vec3 colour = mix(sky, mix(haze, hill, FAR_COLOUR), smoothstep(HILL_EDGE, -HILL_EDGE, h - far));
  colour = mix(colour, mix(haze, hill, NEAR_COLOUR), smoothstep(HILL_EDGE, -HILL_EDGE, h - near));
  colour = mix(colour, mix(haze, ground, smoothstep(0.0, -GROUND_DEPTH, h)), smoothstep(HORIZON_EDGE, -HORIZON_EDGE, h));
  gl_FragColor = vec4(colour, 1.0);
}`;

/** Makes a sphere with the sky on its inside. @param {number[]} up @param {THREE.Vector3} sun unit vector @param {THREE.Texture} noise */
export function skySphere(up, sun, noise) {
  const uniforms = { up: new THREE.Vector3(...up), sun, haze: HAZE, zenith: ZENITH, ground: GROUND, hill: HILL, noise };
  const material = new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }])),
    side: THREE.BackSide,
    depthWrite: false,
    toneMapped: false,
  });
  return new THREE.Mesh(new THREE.SphereGeometry(10, 48, 32), material);
}

const BACKGROUND_VERTEX = /* glsl */ `
varying vec3 direction;
void main() {
  direction = position;
  gl_Position = (projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0)).xyww;
}`;

const BACKGROUND_FRAGMENT = /* glsl */ `
varying vec3 direction;
uniform samplerCube cube;
void main() {
  gl_FragColor = textureCube(cube, direction);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
}`;

/** Makes the background from the cube, drawn after solid parts, which saves hidden pixels. */
export function skyBackground() {
  const uniforms = { cube: { value: null } };
  const look = { uniforms, vertexShader: BACKGROUND_VERTEX, fragmentShader: BACKGROUND_FRAGMENT, side: THREE.BackSide, depthWrite: false };
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(), new THREE.ShaderMaterial(look));
  return Object.assign(mesh, { renderOrder: Infinity, frustumCulled: false });
}
