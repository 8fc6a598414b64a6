// What a page can ask for: `play` for recordings, `drive` for an FMU that runs in the page.
export { play } from "./player/play.js";
export { drive } from "./live/drive.js";
export { SceneView } from "./scene/scene_view.js";
