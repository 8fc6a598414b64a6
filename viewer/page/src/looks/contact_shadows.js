// Contact shadows: soft dark areas on the ground below the body and each wheel.
import * as THREE from "three";
import { add, cross, dot, perpendicular, rotate, scale, subtract } from "../scene/math.js";
import { discard } from "./discard.js";
import { laid, LIFT } from "./ground_offset.js";
import { groundHeight } from "./road_height.js";
import { atEachPixel, atEachPoint } from "./vertex_code.js";

/** Darkness of the middle of shadows of body and wheel, with shadows of the sun and without. */
const [DARKNESS_WITH_SUN, DARKNESS_WITHOUT_SUN] = [[0.4, 0.6], [0.62, 0.62]]; // prettier-ignore
/** Size of the shadow of the body relative to the rectangle of its wheels, and of a wheel relative to its radius and width. */
const [BODY_LENGTH, BODY_WIDTH, WHEEL_LENGTH, WHEEL_WIDTH] = [1.42, 1.2, 1.3, 1.3];
/** Depth offset as a share of the distance, between those of paint and tyre marks. */
const DEPTH_OFFSET = 0.005;
/** Height of a body with half of the darkness, m. */
const HALF_DARKNESS_HEIGHT = 1;

const DARK = /* glsl */ `
vec2 inside = 1.0 - vCorner * vCorner;
diffuseColor.a *= vDark * smoothstep(0.0, 0.55, inside.x * inside.y);`;

/** Makes the shadows. @param {Data} view the SceneView */
export function contactShadows(view) {
  const { scene, parts, up } = view;
  const wheels = (scene.shapes ?? []).filter(({ kind }) => kind === "wheel");
  const count = wheels.length > 0 ? wheels.length + 1 : 0;
  const geometry = new THREE.BufferGeometry();
  const places = new THREE.BufferAttribute(new Float32Array(12 * count), 3).setUsage(THREE.DynamicDrawUsage);
  const darks = new THREE.BufferAttribute(new Float32Array(4 * count), 1).setUsage(THREE.DynamicDrawUsage);
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]]; // prettier-ignore
  geometry.setAttribute("position", places);
  geometry.setAttribute("dark", darks);
  geometry.setAttribute("corner", new THREE.BufferAttribute(Float32Array.from(Array(count).fill(corners).flat(2)), 2));
  geometry.setIndex(Array.from({ length: count }, (_, k) => [0, 1, 2, 0, 2, 3].map((i) => 4 * k + i)).flat());
  const mesh = new THREE.Mesh(geometry, material());
  mesh.frustumCulled = false;
  mesh.renderOrder = 0.5;
  const put = (k, middle, ahead, left, dark, origin, least) => {
    corners.forEach(([a, b], i) => {
      const corner = add(middle, add(scale(ahead, a), scale(left, b)));
      const level = groundHeight(view, corner) ?? least;
      const gap = Math.max(0, dot(middle, up) - level);
      places.array.set(subtract(add(corner, scale(up, level + LIFT - dot(corner, up))), origin), 12 * k + 3 * i);
      darks.array[4 * k + i] = dark / (1 + (gap / HALF_DARKNESS_HEIGHT) ** 2);
    });
  };
  return {
    mesh,
    /** @param {number[]} origin earth position of the origin of the picture, m @param {boolean} alone without shadows of the sun */
    follow(origin, alone) {
      const [body, wheel] = alone ? DARKNESS_WITHOUT_SUN : DARKNESS_WITH_SUN;
      const centres = wheels.map(({ frame, at }) => parts.frames.point(frame, at ?? [0, 0, 0]));
      mesh.visible = count > 0 && centres.every((centre) => centre !== null);
      if (!mesh.visible) return;
      const { rotation } = parts.frames.pose(scene.focus || wheels[0].frame);
      const level = (direction) => perpendicular(direction, up) ?? [1, 0, 0];
      const forward = level(rotate(rotation, [1, 0, 0]));
      const left = cross(up, forward);
      const least = Math.min(...centres.map((centre, k) => dot(centre, up) - wheels[k].radius));
      const spread = [forward, left].map((direction) => {
        const along = centres.map((centre) => dot(centre, direction));
        return [0.5 * (Math.min(...along) + Math.max(...along)), 0.5 * (Math.max(...along) - Math.min(...along))];
      });
      const middle = add(add(scale(forward, spread[0][0]), scale(left, spread[1][0])), scale(up, least));
      const radius = wheels[0].radius;
      const long = spread[1][1] > radius ? BODY_LENGTH : 1; // a vehicle with wheels in one line does not extend beyond them
      put(0, middle, scale(forward, long * spread[0][1] + radius), scale(left, BODY_WIDTH * spread[1][1] + 0.3 * radius), body, origin, least);
      centres.forEach((centre, k) => {
        const bottom = add(centre, scale(up, -wheels[k].radius));
        const axle = level(rotate(parts.frames.pose(wheels[k].frame).rotation, wheels[k].axis ?? [0, 1, 0]));
        put(k + 1, bottom, scale(cross(axle, up), WHEEL_LENGTH * wheels[k].radius), scale(axle, WHEEL_WIDTH * wheels[k].width), wheel, origin, least);
      });
      places.needsUpdate = darks.needsUpdate = true;
    },
    dispose: () => discard(mesh),
  };
}

const material = () =>
  laid("contact-shadows", DEPTH_OFFSET, { color: "#05060a" }, (shader) => {
    const head = "varying vec2 vCorner;\nvarying float vDark;";
    atEachPoint(shader, `attribute vec2 corner;\nattribute float dark;\n${head}`, "vCorner = corner;\nvDark = dark;");
    atEachPixel(shader, head, { color_fragment: DARK });
  });
