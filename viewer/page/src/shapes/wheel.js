import * as THREE from "three";
import { across, cross, dot, fromColumns, rotate, scale, subtract, transpose, unit } from "../scene/math.js";
import { turn } from "./place.js";
import { treadTexture } from "./tread.js";

const SPOKES = 5;
const vectors = (list) => list.map(([r, y]) => new THREE.Vector2(r, y));

/** Half of a tyre's profile from the bead to the middle of the tread, and where the tread begins. */
function halfProfile(r, rim, w) {
  const side = r - rim;
  const bead = [[rim, 0.34 * w], [rim, 0.41 * w], [rim + 0.06 * side, 0.44 * w]]; // prettier-ignore
  const wall = Array.from({ length: 7 }, (_, i) => {
    const a = (i / 6) * 0.82 * Math.PI;
    return [rim + side * (0.12 + 0.62 * (i / 6)), w * (0.445 + 0.055 * Math.sin(a))];
  });
  const shoulder = Array.from({ length: 5 }, (_, i) => {
    const a = ((i + 1) / 5) * (Math.PI / 2);
    return [r - side * (0.26 - 0.24 * Math.sin(a)), w * (0.36 + 0.11 * Math.cos(a))];
  });
  const groove = 0.06 * side;
  const tread = [[r - 0.004 * side, 0.3 * w], [r, 0.24 * w], [r - groove, 0.235 * w], [r - groove, 0.19 * w], [r, 0.185 * w], [r, 0.09 * w],
    [r - groove, 0.085 * w], [r - groove, 0.04 * w], [r, 0.035 * w], [r, 0]]; // prettier-ignore
  return { half: [...bead, ...wall, ...shoulder, ...tread], start: bead.length + wall.length + 2 };
}

function tyre(r, rim, w, materials) {
  const { half, start } = halfProfile(r, rim, w);
  const profile = [...half.map(([x, y]) => [x, -y]), ...half.slice(0, -1).reverse()];
  const geometry = new THREE.LatheGeometry(vectors(profile), 48);
  const material = materials.named("rubber").clone();
  if (!materials.options.ghost) {
    material.color.set("#48494c");
    material.map = treadTexture([start / (profile.length - 1), 1 - start / (profile.length - 1)]);
  }
  return { mesh: new THREE.Mesh(geometry, material), owned: [material, material.map].filter(Boolean) };
}

/** Face of the rim: a disc with windows between the spokes. */
function face(rim, thickness) {
  const disc = new THREE.Shape().absarc(0, 0, 0.97 * rim, 0, 2 * Math.PI);
  const [inner, outer] = [0.3 * rim, 0.86 * rim];
  for (let i = 0; i < SPOKES; i++) {
    const middle = ((i + 0.5) / SPOKES) * 2 * Math.PI;
    const [near, far] = [0.2 * Math.PI - 0.36, 0.2 * Math.PI - 0.13];
    const hole = new THREE.Path();
    hole.absarc(0, 0, outer, middle - far, middle + far, false);
    hole.absarc(0, 0, inner, middle + near, middle - near, true);
    hole.closePath();
    disc.holes.push(hole);
  }
  const bevel = 0.035 * rim;
  const shape = { depth: thickness, bevelEnabled: true, bevelThickness: bevel, bevelSize: bevel, bevelSegments: 1, curveSegments: 10 };
  return new THREE.ExtrudeGeometry(disc, shape).rotateX(-Math.PI / 2).translate(0, -thickness / 2, 0);
}

function rimParts(rim, w, out, materials) {
  const metal = materials.named("rim");
  const barrel = vectors([[0.93 * rim, -0.4 * w], [rim, -0.43 * w], [rim, -0.36 * w], [0.9 * rim, -0.3 * w], [0.86 * rim, 0], [0.9 * rim, 0.3 * w],
    [rim, 0.36 * w], [rim, 0.43 * w], [0.93 * rim, 0.4 * w]]); // prettier-ignore
  /** @type {THREE.Mesh[]} */
  const parts = [
    new THREE.Mesh(new THREE.LatheGeometry(barrel, 44), materials.named("rim", undefined, undefined, true)),
    new THREE.Mesh(face(rim * 0.94, 0.08 * w).translate(0, 0.2 * w * out, 0), metal),
    new THREE.Mesh(new THREE.CylinderGeometry(0.17 * rim, 0.19 * rim, 0.56 * w, 28), materials.named("dark_paint")),
  ];
  if (out) parts.push(new THREE.Mesh(new THREE.CylinderGeometry(0.66 * rim, 0.66 * rim, 0.1 * w, 40).translate(0, -0.12 * w * out, 0), materials.named("steel")));
  // One valve: it tells a turned wheel from another of the same five spokes.
  const valve = new THREE.Mesh(new THREE.SphereGeometry(0.05 * rim, 12, 8), materials.named("plastic", "#d8412f"));
  valve.position.set(0.8 * rim, (0.2 * out + 0.07) * w, 0);
  parts.push(valve);
  if (!out) parts.push(valve.clone().translateY(-0.14 * w));
  return parts;
}

/** Side of the car that a wheel stands on, along its axis: 1, -1, or 0 in the middle. */
function outward(shape, axis, { frames, scene }) {
  const body = frames.pose(scene.focus || "ground");
  const { position, rotation } = frames.pose(shape.frame);
  const to = rotate(transpose(rotation), subtract(position, body.position));
  const along = dot(to, axis);
  return Math.abs(along) > 0.5 * shape.radius ? Math.sign(along) : 0;
}

/** A wheel with tyre, rim and spokes. @param {Data} shape @param {import("./index.js").Context} context */
export function wheel(shape, context) {
  const { radius, width, rim = 0.65 * radius, axis = [0, 1, 0] } = shape;
  const out = outward(shape, axis, context);
  const { mesh, owned } = tyre(radius, rim, width, context.materials);
  const object = new THREE.Group().add(mesh, ...rimParts(rim, width, out, context.materials));
  object.position.fromArray(shape.at ?? [0, 0, 0]);
  const y = unit(axis) ?? [0, 1, 0];
  const x = Math.abs(y[0]) < 0.9 ? unit(subtract([1, 0, 0], scale(y, y[0]))) : across(y);
  turn(object, fromColumns(x, y, cross(x, y)));
  return { object, frame: shape.frame, owned };
}
