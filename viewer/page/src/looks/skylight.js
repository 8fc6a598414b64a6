// Adds diffuse light of the sky to materials without reflections.
import { atEachPixel } from "./vertex_code.js";

/** Code after the lights of a Lambert material of three.js. */
export const SKYLIGHT = "reflectedLight.indirectDiffuse += vec3(0.34, 0.39, 0.47) * diffuseColor.rgb;";

/** Adds the light to a material. @param {import("three").Material} material @param {(shader: Data) => void} [more] further changes of the shader */
export function skylit(material, more = () => {}) {
  material.onBeforeCompile = (shader) => {
    atEachPixel(shader, "", { lights_fragment_end: SKYLIGHT });
    more(shader);
  };
  const key = `ali3-skylit-${more}`;
  material.customProgramCacheKey = () => key;
  return material;
}
