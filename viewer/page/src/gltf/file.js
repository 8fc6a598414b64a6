// Collects the nodes of a binary glTF file and their motion; the exporter of three.js writes it.
import { Buffer } from "node:buffer";
import fs from "node:fs";
import * as THREE from "three";
import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";
import { largestErrors, thinned } from "./motion.js";

/** The method of FileReader in browsers that the exporter uses. */
class FileReader {
  readAsArrayBuffer = async (/** @type {Blob} */ blob) => {
    Object.assign(this, { result: await blob.arrayBuffer() });
    /** @type {Data} */ (this).onloadend();
  };
}

/** A glTF file: nodes, their motion, and the largest errors of it. */
export class File {
  /** @param {string} name @param {Float64Array} t s @param {number} rate retained times per second */
  constructor(name, t, rate) {
    this.t = t;
    this.rate = rate;
    this.scene = new THREE.Scene();
    this.scene.name = name;
    this.tracks = [];
    this.names = new Map();
    /** Largest errors of position, m, and rotation, rad. */
    this.error = [0, 0];
  }

  /** Adds a node; further nodes of the same name get a number. @template {THREE.Object3D} T @param {T} object @param {string} name @param {THREE.Object3D} [parent] */
  add(object, name, parent = this.scene) {
    const number = (this.names.get(name) ?? 0) + 1;
    this.names.set(name, number);
    object.name = number === 1 ? name : `${name} (${number})`;
    parent.add(object);
    return object;
  }

  /** Adds the motion of a node; constant values are written once. @param {THREE.Object3D} node @param {import("./motion.js").Motion} motion @param {number[]} [parentErrors] errors of its parent */
  animate(node, motion, parentErrors = [0, 0]) {
    const track = thinned(motion, this.t, this.rate);
    for (const [path, values] of Object.entries({ position: track.position, quaternion: track.quaternion, scale: track.scale })) {
      if (values === undefined) continue;
      node[path].fromArray(values); // for readers that do not animate
      const size = values.length / track.times.length;
      if (values.some((value, i) => value !== values[i % size])) this._track(node, path, track.times, values);
    }
    return this.count(largestErrors(motion, track, this.t).map((errors, k) => errors + parentErrors[k]));
  }

  /** Adds the weights of the morph targets of a mesh. @param {THREE.Mesh} mesh @param {number[]} indices of times @param {number[]} values */
  bend(mesh, indices, values) {
    if (indices.length > 1) this._track(mesh, "morphTargetInfluences", indices.map((k) => this.t[k]), values);
    else mesh.morphTargetInfluences = values;
  }

  _track(node, path, times, values) {
    const Track = { quaternion: THREE.QuaternionKeyframeTrack, morphTargetInfluences: THREE.NumberKeyframeTrack }[path] ?? THREE.VectorKeyframeTrack;
    this.tracks.push(new Track(`${node.uuid}.${path}`, times, values));
  }

  /** Includes errors in the largest ones. @param {number[]} errors m, rad @returns {number[]} errors */
  count(errors) {
    this.error = this.error.map((most, k) => Math.max(most, errors[k]));
    return errors;
  }

  /** Writes the binary file. @param {string} path */
  async write(path) {
    Object.assign(globalThis, { FileReader });
    const animations = this.tracks.length > 0 ? [new THREE.AnimationClip(this.scene.name, -1, this.tracks)] : [];
    const glb = await new GLTFExporter().register(deduplicating).parseAsync(this.scene, { binary: true, trs: true, animations });
    fs.writeFileSync(path, Buffer.from(/** @type {ArrayBuffer} */ (glb)));
  }
}

/** Plugin that writes equal arrays once, and names of meshes. @param {Data} writer of the exporter */
function deduplicating(writer) {
  const known = new Map();
  const process = writer.processAccessor.bind(writer);
  writer.processAccessor = (attribute, geometry, start = 0, count = Infinity) => {
    const { array, itemSize } = attribute;
    const last = Math.min(array.length, (start + count) * itemSize);
    const { buffer, byteOffset, byteLength } = array.subarray(start * itemSize, last);
    const purpose = geometry === undefined ? "motion" : attribute === geometry.index ? "index" : "points";
    const key = [purpose, array.constructor.name, itemSize, Buffer.from(buffer, byteOffset, byteLength).toString("base64")].join();
    if (!known.has(key)) known.set(key, process(attribute, geometry, start, count));
    return known.get(key);
  };
  return { writeMesh: (mesh, node) => Object.assign(node, { name: mesh.name }) };
}
