// Entry points of the script for pages: pictures of a scene, recordings.
export { playPage } from "./player/play.js";
export { SceneView } from "./scene/scene_view.js";
// An FMU that runs in the page; `serve` is its other side, in the worker.
export { drive } from "./live/drive.js";
export { serve } from "./live/worker.js";
// A car that another program drives, in its simulator.
export { simulate } from "./simulator/simulate.js";
// Devices of the host, for the page of the simulator.
export { CalibrationPanel } from "./simulator/calibration.js";
// Marks, dust and sound of a driven car.
export { CarSound, Dust, TyreMarks } from "./effects/index.js";
