// What a page can ask for: pictures of a scene.
export { SceneView } from "./scene/scene_view.js";
