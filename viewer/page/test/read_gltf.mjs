// Reads a glTF file by three.js: for each time the world matrices of its nodes, and positions of morphed meshes.
import fs from "node:fs";
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

Object.assign(globalThis, { self: globalThis }); // the loader looks for a browser's name of it
const [file, ...times] = process.argv.slice(2);
const data = fs.readFileSync(file);
const gltf = await new GLTFLoader().parseAsync(data.buffer.slice(data.byteOffset, data.byteOffset + data.length), "");
const mixer = new THREE.AnimationMixer(gltf.scene);
for (const clip of gltf.animations) {
  const action = mixer.clipAction(clip);
  action.setLoop(THREE.LoopOnce, 1).clampWhenFinished = true;
  action.play();
}
const associations = gltf.parser.associations;
const answer = times.map((time) => {
  mixer.setTime(Number(time));
  gltf.scene.updateMatrixWorld(true);
  const nodes = {};
  gltf.scene.traverse((object) => {
    const index = associations.get(object)?.nodes;
    if (index !== undefined) nodes[index] = { matrix: object.matrixWorld.toArray(), points: morphed(object) };
  });
  return nodes;
});
console.log(JSON.stringify(answer));

/** Positions of a mesh with morph targets, local; nothing for others. */
function morphed(object) {
  if (!object.isMesh || !object.morphTargetInfluences) return undefined;
  const point = new THREE.Vector3();
  return Array.from({ length: object.geometry.attributes.position.count }, (_, k) => object.getVertexPosition(k, point).toArray());
}
