// Effects of a driven car: tyre marks, dust and sound.
export { Dust } from "./dust.js";
export { CarSound } from "./sound/car_sound.js";
export { TyreMarks } from "./tyre_marks.js";
