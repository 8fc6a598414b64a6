// Merges meshes of one material that are fixed in one frame, so that there are fewer draw calls.
import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

/**
 * Join the meshes under a group that moves as one; transparent ones stay single, so that they can be sorted.
 * What is a tube, which drafts draw otherwise, stays apart from what is none; `tubes` of a mesh places those that it has.
 * @param {THREE.Group} carrier
 */
export function join(carrier) {
  carrier.updateMatrixWorld(true);
  const toCarrier = carrier.matrixWorld.clone().invert();
  const kinds = new Map();
  carrier.traverse((part) => {
    if (!(part instanceof THREE.Mesh) || part.userData.alone || part.userData.cover || part.material.transparent) return;
    const key = `${part.material.uuid} ${part.castShadow} ${part.receiveShadow} ${part.userData.tubes !== undefined}`;
    kinds.set(key, [...(kinds.get(key) ?? []), part]);
  });
  for (const meshes of kinds.values()) {
    if (meshes.length > 1) carrier.add(joined(meshes, toCarrier));
  }
}

function joined(meshes, toCarrier) {
  const { material, castShadow, receiveShadow } = meshes[0];
  const places = meshes.map((mesh) => new THREE.Matrix4().multiplyMatrices(toCarrier, mesh.matrixWorld));
  const pieces = meshes.map((mesh, k) => plain(mesh, places[k]));
  const whole = new THREE.Mesh(mergeGeometries(pieces), material);
  Object.assign(whole, { castShadow, receiveShadow });
  if (meshes[0].userData.tubes) whole.userData.tubes = meshes.flatMap(({ userData }, k) => userData.tubes.map((tube) => places[k].clone().multiply(tube)));
  for (const piece of pieces) piece.dispose();
  for (const mesh of meshes) {
    mesh.removeFromParent();
    mesh.geometry.dispose();
  }
  return whole;
}

/** A geometry of positions, normals and an index, in the axes of the carrier. @param {any} mesh @param {THREE.Matrix4} matrix */
export function plain(mesh, matrix) {
  const { geometry } = mesh;
  const copy = new THREE.BufferGeometry();
  for (const name of ["position", "normal", ...(mesh.material.map ? ["uv"] : [])]) copy.setAttribute(name, geometry.getAttribute(name).clone());
  const count = geometry.getAttribute("position").count;
  copy.setIndex(geometry.index ? geometry.index.clone() : [...Array(count).keys()]);
  return copy.applyMatrix4(matrix);
}
