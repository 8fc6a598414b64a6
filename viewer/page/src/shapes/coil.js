// Computes the surface of the wire of a coil spring of any length.
import shapes from "../../../shapes.json" with { type: "json" };

const { sides: SIDES, per_turn: PER_TURN } = shapes.spring;

/**
 * Height of the middle of the wire: end coils are flat, active coils have the remaining height.
 * @param {number} turn 0 to coils @param {number} coils @param {number} wire diameter @param {number} height length of the spring
 */
export function heightAt(turn, coils, wire, height) {
  const dead = Math.min(shapes.spring.dead[0], shapes.spring.dead[1] * coils);
  const flat = Math.min(wire, height / (coils + 1));
  const rest = height - wire - 2 * dead * flat;
  const active = Math.max(0, Math.min(turn - dead, coils - 2 * dead));
  const ends = Math.min(turn, dead) + Math.max(0, turn - (coils - dead));
  return wire / 2 + ends * flat + (active / (coils - 2 * dead)) * rest;
}

/** Indices of the triangles of a wire. @param {number} coils @param {number} [every] stride of rings and sides @returns {number[]} */
export function coilTriangles(coils, every = 1) {
  const last = Math.round(coils * PER_TURN);
  const sides = Array.from({ length: Math.floor(SIDES / every) }, (_, k) => k * every);
  const triangles = [];
  for (let i = 0; i < last; i += every) {
    const [ring, next] = [i * SIDES, Math.min(i + every, last) * SIDES];
    sides.forEach((side, k) => {
      const other = sides[(k + 1) % sides.length];
      triangles.push(ring + side, next + side, ring + other, ring + other, next + side, next + other);
    });
  }
  return triangles;
}

/**
 * Points and normals of the wire about the y axis, from y = 0; the wire begins at z.
 * @param {{coils: number, radius: number, wire: number}} spring radius: of the middle of the wire, m @param {number} height
 */
export function coilSurface({ coils, radius, wire }, height) {
  const rings = Math.round(coils * PER_TURN) + 1;
  const positions = new Float32Array(rings * SIDES * 3);
  const normals = new Float32Array(rings * SIDES * 3);
  const slope = height / coils / (2 * Math.PI * radius);
  const flat = 1 / Math.hypot(1, slope);
  for (let i = 0; i < rings; i++) {
    const turn = (i / (rings - 1)) * coils;
    const [sine, cosine] = [Math.sin(2 * Math.PI * turn), Math.cos(2 * Math.PI * turn)];
    const y = heightAt(turn, coils, wire, height);
    for (let j = 0; j < SIDES; j++) {
      const [out, up] = [Math.cos((2 * Math.PI * j) / SIDES), flat * Math.sin((2 * Math.PI * j) / SIDES)];
      const normal = [out * sine - up * slope * cosine, up, out * cosine + up * slope * sine];
      const k = 3 * (i * SIDES + j);
      normals.set(normal, k);
      positions.set([radius * sine + (wire / 2) * normal[0], y + (wire / 2) * up, radius * cosine + (wire / 2) * normal[2]], k);
    }
  }
  return { positions, normals };
}
