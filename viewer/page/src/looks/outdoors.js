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
import { HAZE, seenSky, skyBall } from "./sky.js";
import { sharpen, sunLight } from "./sun.js";
import { makeWorld } from "./world.js";

/** Makes the look. @param {Data} view the SceneView @param {boolean} fine whether there is a graphics card */
export function outdoors(view, fine) {
  const { world, renderer, up, extent, scene } = view;
  const x = across(up);
  const direction = unit(add(scale(up, 0.72), add(scale(x, 0.62), scale(cross(up, x), -0.38))));
  const sun = sunLight({ direction, reach: 1.2 * view.radius, strength: 3.4, color: "#fff1dc", size: fine ? 2048 : 1024 });
  world.add(sun);
  renderer.toneMapping = THREE.ACESFilmicToneMapping;
  renderer.toneMappingExposure = 1.15;
  world.fog = new THREE.Fog(HAZE, 60 + 15 * extent, 700 + 60 * extent);
  const environment = {};
  const pixels = new THREE.Vector2();
  const noise = noiseTexture(fine ? 8 : 1);
  /** Draws the sky to a cube for background and reflections; returns it as a scene. */
  const makeSky = () => {
    environment.cube?.dispose();
    const skyScene = new THREE.Scene().add(skyBall(up, new THREE.Vector3(...direction), noise));
    environment.cube = new THREE.WebGLCubeRenderTarget(fine ? 1024 : 512, { type: THREE.HalfFloatType });
    new THREE.CubeCamera(0.1, 100, environment.cube).update(renderer, skyScene);
    sky.material.uniforms.cube.value = environment.cube.texture;
    land?.mirror(environment.cube.texture);
    return skyScene;
  };
  const sky = seenSky();
  world.add(sky);
  const land = makeWorld(scene, { up, noise, sun: new THREE.Vector3(...direction), fine });
  if (land !== null) world.add(land.group);
  const light = reflecting(view, makeSky, { fine, intensity: 0.75 });
  const asphalt = groundMaterial({ noise, up, paint: 1, fine });
  const road = groundMaterial({ noise, up, fine });
  const grass = groundMaterial({ noise, up, grass: true });
  const roads = makeRoads(scene, { up, asphalt: asphalt.material, road: road.material, grass: grass.material });
  world.add(roads.group);
  const draft = makeDraft(view, sun);
  const shadows = contactShadows(view);
  world.add(shadows.mesh);
  /** Draft materials by the materials of the ground. */
  const twins = new Map();
  const dress = (on) => {
    if (on && twins.size === 0) for (const { material, drafted } of [asphalt, road, grass]) twins.set(material, drafted(draft.light));
    const owns = new Map([...twins].map(([own, twin]) => [twin, own]));
    roads.dress((material) => (on ? twins : owns).get(material) ?? material);
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
      sharpen(sun, level === "high" ? 2048 : 1024);
      draft.set(level);
      dress(draft.on);
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
      for (const twin of twins.values()) twin.dispose();
      for (const { material } of [asphalt, road, grass]) material.dispose();
      noise.dispose();
      discard(sky);
      sun.dispose();
      environment.cube.dispose();
      light.dispose();
    },
  };
}
