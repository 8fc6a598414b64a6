// The tyres of a scene, with the wheels that wear them; pure numbers.
import { dot, finite, rotate, subtract, transpose, unit } from "./math.js";

/**
 * @param {Data} scene
 * @returns {{tyre: Data, prefix: string, shape: Data | undefined}[]} of each arrow of a tyre its columns, what their names begin
 *   with, and the wheel of that name, else the first
 */
export function tyresOf(scene) {
  const shapes = (scene.shapes ?? []).filter(({ kind }) => kind === "wheel");
  const bare = (name) => name.replace(/\W|_/g, "");
  return (scene.arrows ?? [])
    .filter(({ tyre }) => tyre !== undefined)
    .map(({ tyre }) => {
      const prefix = tyre.forces[0].replace(/\.[^.]*$/, "");
      return { tyre, prefix, shape: shapes.find(({ frame }) => bare(frame) === bare(prefix)) ?? shapes[0] };
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
  const way = unit(normal);
  if (way === null) return null;
  const local = rotate(transpose(rotation), way);
  return [...local, dot(subtract(at, position), way)];
}
