// Draws the solid parts of a scene in one call, with fewer triangles and colours at their points.
import * as THREE from "three";
import { vertexLit } from "./vertex_lighting.js";
import { within } from "./vertex_clustering.js";
import { growing, prisms } from "./tubes.js";

/** Largest number of triangles of all parts, of which solid parts may have at least half. */
export const MOST = 12000;
/** Cell size of the finest lattice, as a share of the size of the drawing. */
const FINEST_CELL = 1.5e-3;
/** Layer that cameras do not draw. */
const HIDDEN_LAYER = 1;

/** Whether a mesh is drawn separately: it is transparent, or its form or look changes. @param {THREE.Mesh} mesh */
const isSeparate = (mesh) => /** @type {THREE.Material} */ (mesh.material).transparent || mesh.userData.alone || mesh.userData.cover;

const colourOf = (mesh) => /** @type {THREE.MeshStandardMaterial} */ (mesh.material).color.toArray();

/** Surface of a mesh in the axes of a group. @param {THREE.Mesh} mesh @param {THREE.Matrix4} toGroup */
function surfaceOf(mesh, toGroup) {
  const geometry = mesh.geometry.clone().applyMatrix4(toGroup.multiply(mesh.matrixWorld));
  const { position, normal } = geometry.attributes;
  const colour = colourOf(mesh);
  const index = geometry.index?.array ?? [...Array(position.count).keys()];
  geometry.dispose();
  return { positions: position.array, normals: normal.array, colours: Array.from(position.array, (_, k) => colour[k % 3]), index };
}

function joined(surfaces) {
  const mesh = { positions: [], normals: [], colours: [], index: [] };
  for (const { positions, normals, colours, index } of surfaces) {
    const from = mesh.positions.length / 3;
    for (const value of index) mesh.index.push(from + value);
    for (const value of positions) mesh.positions.push(value);
    for (const value of normals) mesh.normals.push(value);
    for (const value of colours) mesh.colours.push(value);
  }
  return mesh;
}

function geometryOf({ positions, normals, colours, index }, tubes) {
  const geometry = new THREE.BufferGeometry();
  const thicks = [...Array(positions.length / 3).fill(0), ...tubes.thicks];
  const whole = joined([{ positions, normals, colours, index }, tubes]);
  for (const [name, values] of Object.entries({ position: whole.positions, normal: whole.normals, color: whole.colours, thick: thicks })) {
    geometry.setAttribute(name, new THREE.BufferAttribute(Float32Array.from(values), name === "thick" ? 1 : 3));
  }
  return geometry.setIndex(whole.index);
}

const sumOf = (surfaces, name) => surfaces.reduce((sum, surface) => sum + surface[name].length, 0);

/**
 * Makes the mesh of all solid parts.
 * @param {import("../../scene/parts.js").Parts} parts
 * @param {Data} light of `lightOf` @param {number} extent
 */
export function baked(parts, light, extent) {
  parts.group.updateMatrixWorld(true);
  const hidden = [];
  const movers = [];
  const single = new Map();
  const coarsened = new Set();
  const collect = (object, bends) => {
    const meshes = [];
    object.traverse((part) => {
      if (!(part instanceof THREE.Mesh)) return;
      if (part.userData.coarse !== undefined) coarsened.add(part);
      if (!isSeparate(part)) meshes.push(part);
      else if (!bends || !part.userData.alone) single.set(part, part.material);
    });
    return meshes;
  };
  const carriers = parts.moving.map(([, carrier]) => carrier);
  for (const carrier of carriers) movers.push({ object: carrier, meshes: collect(carrier, true) });
  for (const { object, update } of parts.shapes) if (update) for (const mesh of collect(object, false)) movers.push({ object: mesh, meshes: [mesh] });
  const solid = movers.filter(({ meshes }) => meshes.length > 0);
  const tubes = solid.map(({ object, meshes }) => {
    const inverse = object.matrixWorld.clone().invert();
    const places = (mesh) => mesh.userData.tubes.map((tube) => inverse.clone().multiply(mesh.matrixWorld).multiply(tube));
    const prismatic = meshes.filter(({ userData }) => userData.tubes).map((mesh) => prisms(places(mesh), colourOf(mesh)));
    return { ...joined(prismatic), thicks: prismatic.flatMap(({ thicks }) => thicks) };
  });
  const otherTriangles = [...coarsened].reduce((sum, { userData }) => sum + (userData.coarse.count ?? userData.coarse.length) / 3, 0) + sumOf(tubes, "index") / 3;
  const surfaces = within(solid.map(({ object, meshes }) => {
    const inverse = object.matrixWorld.clone().invert();
    return joined(meshes.filter(({ userData }) => !userData.tubes).map((mesh) => surfaceOf(mesh, inverse.clone())));
  }), Math.max(MOST / 2, MOST - otherTriangles), FINEST_CELL * extent); // prettier-ignore
  for (const { meshes } of solid) hidden.push(...meshes);
  const drawn = solid.map((mover, k) => ({ ...mover, surface: surfaces[k], tubes: tubes[k] })).filter(({ surface, tubes: { index } }) => surface.index.length + index.length > 0);
  const [points, corners] = ["positions", "index"].map((name) => sumOf(surfaces, name) + sumOf(tubes, name));
  const thicken = (shader) => growing(shader, light.aLeast);
  const material = vertexLit(light, { vertexColors: true, side: THREE.DoubleSide }, "baked", thicken);
  const batch = new THREE.BatchedMesh(Math.max(1, drawn.length), Math.max(3, points / 3), Math.max(3, corners), material);
  Object.assign(batch, { frustumCulled: false, perObjectFrustumCulled: false, sortObjects: false });
  for (const mover of drawn) mover.id = batch.addInstance(batch.addGeometry(geometryOf(mover.surface, mover.tubes)));
  const twins = new Map();
  for (const own of new Set(single.values())) {
    const { color, opacity, side, transparent, depthWrite } = own;
    twins.set(own, vertexLit(light, { color, opacity, side, transparent, depthWrite }, `single ${transparent}`));
  }
  const steel = new Map(parts.flexible.map((body) => [body, vertexLit(light, { color: body.plain.color }, "steel", thicken)]));
  return {
    mesh: batch,
    /** Draws this mesh in place of the parts, or the parts. @param {boolean} on */
    show(on) {
      batch.visible = on;
      if (!on) for (const { least } of parts.flexible) least.value = 0;
      for (const mesh of hidden) mesh.layers.set(on ? HIDDEN_LAYER : 0);
      for (const [mesh, own] of single) mesh.material = on ? twins.get(own) : own;
      for (const mesh of coarsened) {
        const { coarse, fine = mesh.geometry.index } = mesh.userData;
        mesh.userData.fine = fine;
        mesh.geometry.setIndex(on ? coarse : fine);
      }
    },
    /** Moves the mesh after the parts. */
    follow() {
      parts.group.updateMatrixWorld(true);
      for (const [own, twin] of twins) {
        const { opacity, transparent, depthWrite } = own;
        if (twin.transparent !== transparent) twin.needsUpdate = true;
        Object.assign(twin, { opacity, transparent, depthWrite });
      }
      for (const [body, plain] of steel) {
        body.least.value = light.aLeast.value;
        if (body.object.material === body.plain) body.object.material = plain;
      }
      for (const { id, object } of drawn) {
        let shown = true;
        for (let at = object; at !== null && at !== parts.group; at = at.parent) shown &&= at.visible;
        batch.setVisibleAt(id, shown);
        batch.setMatrixAt(id, object.matrixWorld);
      }
    },
    dispose() {
      batch.dispose();
      material.dispose();
      for (const twin of [...twins.values(), ...steel.values()]) twin.dispose();
      batch.removeFromParent();
    },
  };
}
