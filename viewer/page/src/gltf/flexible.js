// Meshes of flexible parts: tubes with morph targets, coloured by their largest stress.
import * as THREE from "three";
import { colourAt } from "../looks/colour_map.js";
import { Bending } from "../scene/bending.js";
import { floats } from "../bytes.js";
import { FrameTubes } from "../shapes/frame_tubes.js";
import { spread } from "../sources/sampler.js";

/** Number of times at which stress is computed. */
const SAMPLES = 400;

/**
 * Mesh of a flexible part.
 * @param {Data} part of a scene, with `targets` and `weights`: its modes, or a few combinations of them @param {import("./run.js").Run} run @param {number} factor of the displacement
 * @param {THREE.Material} steel
 * @returns {{mesh: THREE.Mesh, peak: {k: number, stress: number, end: number} | null}} peak: index of the time of the
 *   colours, largest stress, and stress of the last colour
 */
export function flexible(part, run, factor, steel) {
  const { nodes, beams, radii = [], targets } = part;
  const tubes = new FrameTubes(nodes, beams, radii);
  tubes.move(nodes);
  const [pointsPerEnd, ball] = [tubes.first / (2 * beams.length), tubes.ball.length / 3];
  const corners = [...beams.flat().flatMap((node) => Array(pointsPerEnd).fill(node)), ...nodes.flatMap((_, node) => Array(ball).fill(node))];
  const geometry = new THREE.BufferGeometry();
  for (const name of ["position", "normal"]) geometry.setAttribute(name, tubes.geometry.getAttribute(name));
  geometry.setIndex(tubes.geometry.index);
  geometry.morphTargetsRelative = true;
  if (targets.length > 0) {
    geometry.morphAttributes.position = targets.map((target) => {
      const displacements = floats(target);
      return new THREE.BufferAttribute(Float32Array.from(corners.flatMap((node) => [0, 1, 2].map((i) => factor * displacements[3 * node + i]))), 3);
    });
  }
  const peak = largestStress(part, run);
  if (peak === null) return { mesh: new THREE.Mesh(geometry, steel), peak };
  tubes.colour(peak.values, peak.end);
  const level = tubes.geometry.getAttribute("level").array;
  const colours = Float32Array.from([...level].flatMap((share) => new THREE.Color().setRGB(.../** @type {[number, number, number]} */ (colourAt(share).map((value) => value / 255)), THREE.SRGBColorSpace).toArray()));
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  return { mesh: new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ name: "stress", metalness: 0.1, roughness: 0.6 })), peak };
}

/** Time of the largest stress of the beam ends, and the stress of all of them at that time. @param {Data} part @param {import("./run.js").Run} run */
function largestStress(part, run) {
  if (!part.stress || part.beams.length === 0) return null;
  const bending = new Bending(part);
  let peak = null;
  for (const k of spread(run.count, SAMPLES)) {
    if (bending.update(run.lookup(k), 0) !== "") continue; // not computed at that time
    const stress = bending.stress.reduce((a, b) => Math.max(a, b), 0);
    if (peak === null || stress > peak.stress) peak = { k, stress, values: bending.stress.slice() };
  }
  return peak && { ...peak, end: part.stress.range || peak.stress || 1 };
}
