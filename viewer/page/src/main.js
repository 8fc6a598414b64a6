// Entry points of the script of the page.
// Pictures of scenes, and recordings.
export { Player } from "./player/play.js";
export { SceneView } from "./scene/scene_view.js";
// An FMU that runs in the page; `serve` runs in its worker.
export { Drive } from "./live/drive.js";
export { serve } from "./live/worker.js";
// The driving simulator.
export { Simulator } from "./simulator/simulate.js";
// Calibration of devices of the driving simulator.
export { CalibrationPanel } from "./simulator/calibration.js";
// Marks, dust and sound of a driven car.
export { Dust } from "./effects/dust.js";
export { CarSound } from "./effects/sound/car_sound.js";
export { TyreMarks } from "./effects/tyre_marks.js";
