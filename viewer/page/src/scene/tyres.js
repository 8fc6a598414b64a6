// Finds the tyres of a scene and their wheels, and the road plane below a wheel.
import { dot, finite, rotate, subtract, transpose, unit } from "./math.js";

/**
 * Tyres of a scene.
 * @param {Data} scene
 * @returns {{tyre: Data, slips: Record<string, string>, shape: Data | undefined}[]} for each arrow of a tyre: its columns, those of
 *   its slips and speeds, and the wheel of the same name or the only wheel, if there is one
 */
export function tyresOf(scene) {
  const shapes = (scene.shapes ?? []).filter(({ kind }) => kind === "wheel");
  const withoutPunctuation = (name) => name.replace(/\W|_/g, "");
  return (scene.arrows ?? [])
    .filter(({ tyre }) => tyre !== undefined)
    .map(({ tyre, slips }) => {
      // With names of another program, columns of a tyre may have different prefixes.
      const prefixes = [tyre.forces, tyre.contact].map(([name]) => name.replace(/\.[^.]*$/, ""));
      const shapeOf = (prefix) => shapes.find(({ frame }) => withoutPunctuation(frame) === withoutPunctuation(prefix));
      const prefix = prefixes.find(shapeOf) ?? prefixes[0];
      const defaults = { slip: `${prefix}.slip`, slip_angle: `${prefix}.slip_angle`, omega: `${prefix}.omega`, speed: "speed" };
      return { tyre, slips: { ...defaults, ...slips }, shape: shapeOf(prefix) ?? (shapes.length === 1 ? shapes[0] : undefined) };
    });
}

/**
 * The plane of the road under a wheel, in the axes of the wheel.
 * @param {Data} tyre columns
 * @param {(name: string) => number | undefined} lookup
 * @param {{position: number[], rotation: number[], shown: boolean}} pose of the wheel
 * @returns {number[] | null} normal, and distance of the plane from the origin of the wheel along it; null: not known
 */
export function roadUnder(tyre, lookup, { position, rotation, shown }) {
  const [at, normal] = [tyre.contact, tyre.normal].map((names) => names.map((name) => lookup(name)));
  if (!shown || !finite([...at, ...normal])) return null;
  const direction = unit(normal);
  if (direction === null) return null;
  const local = rotate(transpose(rotation), direction);
  return [...local, dot(subtract(at, position), direction)];
}
