// Poses of the frames of a scene by the page's own code: [scene, [numbers by column, ...]] comes in, poses go out.
import fs from "node:fs";
import { Frames } from "../src/scene/frames.js";
import { toQuaternion } from "../src/scene/math.js";

const [scene, rows] = JSON.parse(fs.readFileSync(0, "utf8"));
const frames = new Frames(scene);
const answer = rows.map((row) => {
  frames.update((name) => row[name]);
  const of = (name) => {
    const { position, rotation, shown } = frames.pose(name);
    return { position, quaternion: toQuaternion(rotation), shown };
  };
  return Object.fromEntries(Object.keys(scene.frames).map((name) => [name, of(name)]));
});
console.log(JSON.stringify(answer));
