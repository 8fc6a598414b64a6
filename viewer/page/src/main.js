// What a page can ask for: pictures of a scene, recordings.
export { play } from "./player/play.js";
export { playPage } from "./player/page.js";
export { SceneView } from "./scene/scene_view.js";
// An FMU that runs in the page; `serve` is its other side, in the worker.
export { drive } from "./live/drive.js";
export { serve } from "./live/worker.js";
