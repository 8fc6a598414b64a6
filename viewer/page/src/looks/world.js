// Makes a world: terrain and scenery with their materials, fine or coarse.
import * as THREE from "three";
import { coverage } from "./coverage.js";
import { HeightField, SURFACES, SurfaceRaster } from "./heights.js";
import { groundAxes } from "./roads.js";
import { makeScenery, tellOf } from "./scenery/index.js";
import { surfaceMaterials } from "./surface.js";
import { FINE, ROUGH, terrain } from "./terrain.js";

/**
 * Makes the world of a scene.
 * @param {Data} scene
 * @param {{up: number[], noise: THREE.Texture, sun: THREE.Vector3, fine: boolean}} looks sun: unit vector to it
 * @returns {Data | null} null without terrain and scenery
 */
export function makeWorld(scene, { up, noise, sun, fine }) {
  const roads = (scene.roads ?? []).filter(({ kind }) => kind === "terrain");
  const things = scene.scenery ?? [];
  if (roads.length === 0 && things.length === 0) return null;
  const axes = [...groundAxes({}, up), up];
  const tell = [];
  if (roads.length > 1) tell.push(`${roads.length} terrains are in the scene; the first is drawn.`);
  const [field, raster] = roads.length > 0 ? [new HeightField(roads[0]), new SurfaceRaster(roads[0].surface)] : [null, null];
  const unknown = (raster?.names ?? []).filter((name) => !SURFACES.includes(name));
  for (const name of unknown) tell.push(`The surface '${name}' is not known to this page and is drawn as asphalt.`);
  const cover = raster === null ? asphaltCoverage() : coverage(raster, fine ? 8 : 1);
  const materials = surfaceMaterials({ noise, axes, sun, cover, corner: raster?.origin ?? [0, 0], fine });
  const group = new THREE.Group();
  const make = (rough) => {
    const land = field === null ? null : terrain(materials.ground, axes, field, rough ? ROUGH : FINE);
    return versionOf(land, makeScenery(things, { axes, paint: materials.paint, ground: field, drafted: rough }));
  };
  const versions = {};
  let [shown, drafted] = [null, null];
  /** Shows the world at a level; fine and coarse versions are made on first use. @param {string} level @param {Data} light of a draft */
  const show = (level, light) => {
    const rough = level === "low" || level === "draft";
    shown = versions[rough ? "rough" : "fine"] ??= make(rough);
    if (level === "draft") drafted ??= materials.drafted(light);
    if (rough && drafted !== null) dress(shown.group, level === "draft" ? [materials, drafted] : [drafted, materials]);
    group.clear().add(shown.group);
  };
  return {
    group,
    show,
    tell: [...tell, ...tellOf(things)],
    mirror: materials.mirror,
    /** Height of the ground at a point; null without a terrain. @param {number} x @param {number} y */
    height: field === null ? null : (x, y) => field.at(x, y),
    /**
     * @param {number[]} origin earth position of the origin of the picture, m @param {number[]} eye camera, relative to the origin, m
     * @param {THREE.Vector2} pixels size of the picture
     */
    follow(origin, eye, pixels) {
      materials.follow(origin, pixels);
      shown.follow(origin, eye);
    },
    dispose() {
      for (const version of Object.values(versions)) version.dispose();
      for (const pair of [materials, drafted]) for (const name of ["ground", "paint"]) pair?.[name].dispose();
      cover.texture.dispose();
    },
  };
}

/** Replaces the materials of ground and paint. @param {THREE.Group} group @param {Data[]} pair old and new materials */
function dress(group, [old, replacement]) {
  group.traverse((/** @type {THREE.Mesh} */ part) => {
    if (part.material === old.ground) part.material = replacement.ground;
    else if (part.material === old.paint) part.material = replacement.paint;
  });
}

/** Ground and scenery of one quality. */
function versionOf(land, scenery) {
  return {
    group: new THREE.Group().add(...(land === null ? [] : [land.group]), scenery.group),
    follow(origin, eye) {
      land?.follow(origin, eye);
      scenery.follow(origin, eye);
    },
    dispose() {
      land?.dispose();
      scenery.dispose();
    },
  };
}

/** Coverage of a world of asphalt. */
function asphaltCoverage() {
  const texture = new THREE.DataTexture(Uint8Array.of(255, 128, 128, 128), 1, 1);
  texture.needsUpdate = true;
  return { texture, size: [1, 1], start: [0, 0] };
}
