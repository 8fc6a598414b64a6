// What a page can ask for: pictures of a scene, recordings.
export { play } from "./player/play.js";
export { playPage } from "./player/page.js";
export { SceneView } from "./scene/scene_view.js";
