// Makes materials lit from the camera: a surface that faces it has exactly the given colour.
import * as THREE from "three";

const VERTEX = /* glsl */ `
attribute float level;
varying vec3 vNormal, vEye;
varying float vLevel;
#ifdef USE_INSTANCING_COLOR
varying vec3 vColour;
#endif
void main() {
  #include <begin_vertex>
  vec4 at = vec4(transformed, 1.0);
  vec3 outward = normal;
  #ifdef USE_INSTANCING
  mat3 turn = mat3(instanceMatrix);
  outward = turn * (outward / vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2])));
  at = instanceMatrix * at;
  #endif
  #ifdef USE_INSTANCING_COLOR
  vColour = instanceColor;
  #endif
  vec4 seen = modelViewMatrix * at;
  vNormal = normalMatrix * outward;
  vEye = isOrthographic ? vec3(0.0, 0.0, 1.0) : -seen.xyz;
  vLevel = level;
  gl_Position = projectionMatrix * seen;
}`;

// For instances with colours, three.js defines USE_INSTANCING_COLOR in the vertex shader, USE_COLOR in the fragment shader.
const FRAGMENT = /* glsl */ `
varying vec3 vNormal, vEye;
varying float vLevel;
#ifdef USE_COLOR
varying vec3 vColour;
#endif
uniform vec3 colour;
uniform sampler2D map;
void main() {
  vec3 meant = colour;
  #ifdef USE_COLOR
  meant = vColour;
  #endif
  #ifdef BY_LEVEL
  meant = texture2D(map, vec2((0.5 + 255.0 * clamp(vLevel, 0.0, 1.0)) / 256.0, 0.5)).rgb;
  #endif
  float facing = abs(dot(normalize(vNormal), normalize(vEye)));
  gl_FragColor = vec4(meant * mix(0.45, 1.0, smoothstep(0.0, FULL, facing)), 1.0);
  #include <colorspace_fragment>
}`;

/**
 * Makes a material.
 * @param {{color?: string, map?: THREE.Texture, front?: boolean}} options
 *   map: colours by the attribute `level`; instances may have their own colours; front: drawn over everything else
 */
export function headlight({ color = "#ffffff", map = null, front = false }) {
  return new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: { colour: { value: new THREE.Color(color) }, map: { value: map } },
    // Colours of values are independent of the orientation of a tube, except within 20 degrees of its axis.
    defines: map === null ? { FULL: "0.75" } : { FULL: "0.34", BY_LEVEL: 1 },
    toneMapped: false,
    depthTest: !front,
    depthWrite: !front,
    transparent: front, // drawn after solid parts
  });
}
