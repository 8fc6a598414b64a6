// Inserts shader code into a material, per vertex or per pixel.

/** @param {Data} shader of three.js @param {string} declared before all @param {string} code once the place of the point is known, `position` */
export function atEachPoint(shader, declared, code) {
  shader.vertexShader = `${declared}\n${shader.vertexShader}`.replace("#include <begin_vertex>", `#include <begin_vertex>\n${code}`);
}

/** Hands the place on the earth on to the pixels. @param {Data} shader */
export const onTheEarth = (shader) => atEachPoint(shader, "varying vec3 vGround;", "vGround = (modelMatrix * vec4(position, 1.0)).xyz;");

/** @param {Data} shader of three.js @param {string} declared before all @param {Object<string, string>} pieces code after the piece of three.js of that name */
export function atEachPixel(shader, declared, pieces) {
  shader.fragmentShader = `${declared}\n${shader.fragmentShader}`;
  for (const [name, code] of Object.entries(pieces)) {
    shader.fragmentShader = shader.fragmentShader.replace(`#include <${name}>`, `#include <${name}>\n${code}`);
  }
}
