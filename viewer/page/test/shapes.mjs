// Shapes by the page's own code: [scene, numbers by column] comes in; for each shape positions and triangles by colour go out.
import fs from "node:fs";
import * as THREE from "three";
import { Materials } from "../src/looks/materials.js";
import { Frames } from "../src/scene/frames.js";
import { makeShape } from "../src/shapes/index.js";

const [scene, row] = JSON.parse(fs.readFileSync(0, "utf8"));
const frames = new Frames(scene);
frames.update((name) => row[name]);
const context = { materials: new Materials(), frames, scene };

/** Rotation and place of a frame. */
function pose(name) {
  const { position: p, rotation: r } = frames.pose(name);
  return new THREE.Matrix4().set(r[0], r[1], r[2], p[0], r[3], r[4], r[5], p[1], r[6], r[7], r[8], p[2], 0, 0, 0, 1);
}

console.log(
  JSON.stringify(
    scene.shapes.map((shape) => {
      const { object, frame, update } = makeShape(shape, context);
      update?.(([name, local]) => frames.point(name, local));
      const carrier = new THREE.Group().add(object);
      if (frame) carrier.applyMatrix4(pose(frame));
      carrier.updateMatrixWorld(true);
      const found = {};
      carrier.traverse((part) => {
        if (!(part instanceof THREE.Mesh)) return;
        const geometry = part.geometry.clone().applyMatrix4(part.matrixWorld);
        const positions = Array.from(geometry.getAttribute("position").array);
        const triangles = geometry.index ? Array.from(geometry.index.array) : positions.slice(0, positions.length / 3).map((_, k) => k);
        (found[part.material.map ? "tyre" : part.material.color.getHexString()] ??= []).push([positions, triangles]);
      });
      return found;
    }),
  ),
);
