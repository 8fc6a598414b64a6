// Merges meshes of one material in one frame, for fewer draw calls.
import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

/**
 * Merges the meshes of a group that moves as a whole; transparent ones stay separate, so that they can be sorted. Tubes,
 * which drafts draw differently, stay separate from other meshes; `tubes` of a mesh has their matrices.
 * @param {THREE.Group} carrier
 */
export function join(carrier) {
  carrier.updateMatrixWorld(true);
  const toCarrier = carrier.matrixWorld.clone().invert();
  const groups = new Map();
  carrier.traverse((part) => {
    if (!(part instanceof THREE.Mesh) || part.userData.alone || part.userData.cover || part.material.transparent) return;
    const key = `${part.material.uuid} ${part.castShadow} ${part.receiveShadow} ${part.userData.tubes !== undefined}`;
    groups.set(key, [...(groups.get(key) ?? []), part]);
  });
  for (const meshes of groups.values()) {
    if (meshes.length > 1) carrier.add(merged(meshes, toCarrier));
  }
}

function merged(meshes, toCarrier) {
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

/** Geometry of a mesh with positions, normals and index, transformed by a matrix. @param {any} mesh @param {THREE.Matrix4} matrix */
export function plain(mesh, matrix) {
  const { geometry } = mesh;
  const copy = new THREE.BufferGeometry();
  for (const name of ["position", "normal", ...(mesh.material.map ? ["uv"] : [])]) copy.setAttribute(name, geometry.getAttribute(name).clone());
  const count = geometry.getAttribute("position").count;
  copy.setIndex(geometry.index ? geometry.index.clone() : [...Array(count).keys()]);
  return copy.applyMatrix4(matrix);
}
