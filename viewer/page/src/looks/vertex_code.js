// Inserts code into shaders of three.js, per point or per pixel.

/** Inserts code per point. @param {Data} shader of three.js @param {string} declarations declarations @param {string} code after that of the attribute `position` */
export function atEachPoint(shader, declarations, code) {
  shader.vertexShader = `${declarations}\n${shader.vertexShader}`.replace("#include <begin_vertex>", `#include <begin_vertex>\n${code}`);
}

/** Passes the position on the earth to the pixels. @param {Data} shader */
export const onTheEarth = (shader) => atEachPoint(shader, "varying vec3 vGround;", "vGround = (modelMatrix * vec4(position, 1.0)).xyz;");

/** Inserts code per pixel. @param {Data} shader of three.js @param {string} declarations declarations @param {Object<string, string>} pieces code by the name of the chunk of three.js before it */
export function atEachPixel(shader, declarations, pieces) {
  shader.fragmentShader = `${declarations}\n${shader.fragmentShader}`;
  for (const [name, code] of Object.entries(pieces)) {
    shader.fragmentShader = shader.fragmentShader.replace(`#include <${name}>`, `#include <${name}>\n${code}`);
  }
}
