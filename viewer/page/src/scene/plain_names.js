// Checks names and units of a scene; ali3/scene/scene_values.py has the same patterns.

/** A name: no control characters, no < and >. */
export const NAME = /^[^\u0000-\u001f<>\u007f-\u009f\u2028\u2029]*$/;
/** A unit: the same, also no quotes and &. */
const UNIT = /^[^\u0000-\u001f"&'<>`\u007f-\u009f\u2028\u2029]{0,40}$/;

/**
 * Sentence on the first name or unit that is not allowed.
 * @param {Data} scene
 * @returns {string} empty if all are allowed
 */
export function wrongName(scene) {
  const { shapes = [], flexible = [], arrows = [] } = scene;
  const stresses = flexible.map(({ stress }) => stress).filter(Boolean);
  const gauges = flexible.flatMap((part) => part.gauges ?? []);
  const units = [...arrows, ...stresses, ...gauges].map(({ unit }) => unit);
  const names = [
    ...[scene, ...shapes, ...flexible, ...arrows, ...gauges].map(({ name }) => name),
    ...shapes.map(({ body }) => body),
    ...flexible.flatMap((part) => part.names ?? []),
    ...stresses.map((stress) => stress.limit_name),
    ...Object.keys(scene.frames ?? {}),
  ];
  const sentenceOn = (kind, pattern, texts, right) => {
    const found = texts.find((text) => text !== undefined && text !== null && !pattern.test(text));
    return found === undefined ? "" : `The scene has the ${kind} ${JSON.stringify(found).slice(0, 80)}; ${right}.`;
  };
  const right = "without control characters, < and >";
  return sentenceOn("unit", UNIT, units, `a unit is ${right}, quotes and &, of at most 40 characters`) || sentenceOn("name", NAME, names, `a name is ${right}`);
}
