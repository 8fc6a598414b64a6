// Materials lit from where one looks: what faces the eye has exactly the colour that is meant.
import * as THREE from "three";

const VERTEX = /* glsl */ `
attribute float level;
varying vec3 vNormal, vEye;
varying float vLevel;
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  vEye = isOrthographic ? vec3(0.0, 0.0, 1.0) : -seen.xyz;
  vLevel = level;
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = /* glsl */ `
varying vec3 vNormal, vEye;
varying float vLevel;
uniform vec3 colour;
uniform sampler2D map;
void main() {
  vec3 meant = colour;
  #ifdef BY_LEVEL
  meant = texture2D(map, vec2((0.5 + 255.0 * clamp(vLevel, 0.0, 1.0)) / 256.0, 0.5)).rgb;
  #endif
  float facing = abs(dot(normalize(vNormal), normalize(vEye)));
  gl_FragColor = vec4(meant * mix(0.45, 1.0, smoothstep(0.0, 0.75, facing)), 1.0);
  #include <colorspace_fragment>
}`;

/**
 * @param {{color?: string, map?: THREE.Texture, front?: boolean}} options
 *   map: colours by the attribute `level`; front: drawn over everything else
 */
export function headlight({ color = "#ffffff", map = null, front = false }) {
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { colour: { value: new THREE.Color(color) }, map: { value: map } },
    defines: map === null ? {} : { BY_LEVEL: 1 },
    toneMapped: false,
    depthTest: !front,
    depthWrite: !front,
    transparent: front, // drawn after what is solid
  });
}
