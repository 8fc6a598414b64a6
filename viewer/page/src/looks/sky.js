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
float octaves(vec2 p) { return 0.7 * texture2D(noise, p).b + 0.3 * texture2D(noise, p * 5.3 + 0.37).g; }
void main() {
  vec3 d = normalize(direction);
  vec3 x = normalize(abs(up.x) < 0.9 ? cross(up, vec3(1, 0, 0)) : cross(up, vec3(0, 1, 0)));
  vec3 y = cross(up, x);
  float h = dot(d, up);
  float s = max(dot(d, sun), 0.0);
  vec3 sky = mix(haze, zenith, pow(clamp(h, 0.0, 1.0), 0.5));
  sky += vec3(1.0, 0.82, 0.6) * (0.22 * pow(s, 12.0) + 0.5 * pow(s, 220.0));
  vec2 high = vec2(dot(d, x), dot(d, y)) / max(h, 0.02);
  float cloud = smoothstep(0.52, 0.72, octaves(high * 0.085 + 0.3)) * smoothstep(0.03, 0.22, h);
  float lit = 0.72 + 0.4 * octaves(high * 0.23 - 0.5);
  sky = mix(sky, vec3(1.0, 0.99, 0.97) * lit, 0.8 * cloud);
  sky += vec3(1.0, 0.95, 0.86) * 40.0 * smoothstep(0.99985, 0.99993, s) * (1.0 - cloud);
  float around = atan(dot(d, y), dot(d, x));
  vec2 ring = vec2(cos(around), sin(around));
  float far = 0.012 + 0.034 * octaves(ring * 0.31 + 0.9);
  float near = 0.003 + 0.022 * octaves(ring * 0.73 + 0.31);
  vec3 colour = mix(sky, mix(haze, hill, 0.42), smoothstep(0.0015, -0.0015, h - far));
  colour = mix(colour, mix(haze, hill, 0.7), smoothstep(0.0015, -0.0015, h - near));
  colour = mix(colour, mix(haze, ground, smoothstep(0.0, -0.25, h)), smoothstep(0.001, -0.001, h));
  gl_FragColor = vec4(colour, 1.0);
}`;

/** Makes a sphere with the sky on its inside. @param {number[]} up @param {THREE.Vector3} sun unit vector @param {THREE.Texture} noise */
export function skyBall(up, sun, noise) {
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

const SEEN_VERTEX = /* glsl */ `
varying vec3 direction;
void main() {
  direction = position;
  gl_Position = (projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0)).xyww;
}`;

const SEEN = /* glsl */ `
varying vec3 direction;
uniform samplerCube cube;
void main() {
  gl_FragColor = textureCube(cube, direction);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
}`;

/** Makes the background from the cube, drawn after solid parts, which saves hidden pixels. */
export function seenSky() {
  const uniforms = { cube: { value: null } };
  const look = { uniforms, vertexShader: SEEN_VERTEX, fragmentShader: SEEN, side: THREE.BackSide, depthWrite: false };
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(), new THREE.ShaderMaterial(look));
  return Object.assign(mesh, { renderOrder: Infinity, frustumCulled: false });
}
