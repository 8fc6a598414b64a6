// The look of scenes with roads: sky, sun, fog, ground and scenery.
import * as THREE from "three";
import { across, add, cross, scale, unit } from "../scene/math.js";
import { contactShadows } from "./contact_shadows.js";
import { discard } from "./discard.js";
import { makeDraft } from "./draft/index.js";
import { groundMaterial } from "./ground.js";
import { reflecting } from "./environment_map.js";
import { noiseTexture } from "./noise.js";
import { makeRoads } from "./roads.js";
import { HAZE, skyBackground, skySphere } from "./sky.js";
import { sunLight } from "./sun.js";
import { makeWorld } from "./world.js";

/** Direction of the sun: components upwards, across and along the scene. It is chosen by eye, as are the next numbers. */
const SUN = { up: 0.72, across: 0.62, along: -0.38, strength: 3.4, color: "#fff1dc" };
const EXPOSURE = 1.15;
/** Distances at which the fog begins and is opaque, m: constant part, and factor of the extent of the scene. */
const FOG = { near: [60, 15], far: [700, 60] };

/** Makes the look. @param {Data} view the SceneView, whose `world` is the scene of three.js and whose `scene` is that of
 * ALi3 @param {boolean} fine whether there is a graphics card @returns {Data} `restore` draws the reflections again after
 * the graphics card was lost, `height` gives the height of the ground at a position or is null, `tell` are sentences
 * about what could not be drawn */
export function outdoors(view, fine) {
  const { world, renderer, up, extent, scene } = view;
  const x = across(up);
  const direction = unit(add(scale(up, SUN.up), add(scale(x, SUN.across), scale(cross(up, x), SUN.along))));
  const { strength, color } = SUN;
  const sun = sunLight({ direction, reach: 1.2 * view.radius, strength, color, size: fine ? 2048 : 1024 });
  world.add(sun);
  renderer.toneMapping = THREE.ACESFilmicToneMapping;
  renderer.toneMappingExposure = EXPOSURE;
  const [near, far] = [FOG.near, FOG.far].map(([constant, factor]) => constant + factor * extent);
  world.fog = new THREE.Fog(HAZE, near, far);
  const environment = {};
  const pixels = new THREE.Vector2();
  const noise = noiseTexture(fine ? 8 : 1);
  const sky = skyBackground();
  world.add(sky);
  const land = makeWorld(scene, { up, noise, sun: new THREE.Vector3(...direction), fine });
  if (land !== null) world.add(land.group);
  /** Draws the sky to a cube for background and reflections; returns it as a scene. */
  const makeSky = () => {
    environment.cube?.dispose();
    const skyScene = new THREE.Scene().add(skySphere(up, new THREE.Vector3(...direction), noise));
    environment.cube = new THREE.WebGLCubeRenderTarget(fine ? 1024 : 512, { type: THREE.HalfFloatType });
    new THREE.CubeCamera(0.1, 100, environment.cube).update(renderer, skyScene);
    sky.material.uniforms.cube.value = environment.cube.texture;
    land?.mirror(environment.cube.texture);
    return skyScene;
  };
  const light = reflecting(view, makeSky, { fine, intensity: 0.75 });
  const asphalt = groundMaterial({ noise, up, paint: 1, fine });
  const road = groundMaterial({ noise, up, fine });
  const grass = groundMaterial({ noise, up, grass: true });
  const roads = makeRoads(scene, { up, asphalt: asphalt.material, road: road.material, grass: grass.material, extent });
  world.add(roads.group);
  const draft = makeDraft(view, sun);
  const shadows = contactShadows(view);
  world.add(shadows.mesh);
  /** Materials of the draft quality, which graphics in software draw sooner, by the materials of the ground. */
  const draftMaterials = new Map();
  /** Gives the roads the materials of the draft quality, or their own ones. */
  const setDraft = (isDraft) => {
    if (isDraft && draftMaterials.size === 0) {
      for (const { material, drafted } of [asphalt, road, grass]) draftMaterials.set(material, drafted(draft.light));
    }
    const ownMaterials = new Map([...draftMaterials].map(([own, drafted]) => [drafted, own]));
    roads.dress((material) => (isDraft ? draftMaterials : ownMaterials).get(material) ?? material);
  };
  return {
    follow(origin) {
      draft.follow();
      shadows.follow(origin, !sun.castShadow);
      for (const surface of [asphalt, road, grass]) surface.follow(origin);
      const eye = view.cameras.current.position.toArray();
      roads.follow(origin, eye);
      land?.follow(origin, eye, renderer.getDrawingBufferSize(pixels));
    },
    quality(level) {
      draft.set(level);
      setDraft(draft.on);
      land?.show(level, draft.light);
    },
    restore: light.bake,
    height: land?.height ?? null,
    tell: [...roads.unknown, ...(land?.tell ?? [])],
    dispose() {
      draft.dispose();
      shadows.dispose();
      land?.dispose();
      roads.dispose();
      for (const material of draftMaterials.values()) material.dispose();
      for (const { material } of [asphalt, road, grass]) material.dispose();
      noise.dispose();
      discard(sky);
      sun.dispose();
      environment.cube.dispose();
      light.dispose();
    },
  };
}
