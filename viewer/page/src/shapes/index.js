// Makes shapes by their kind: {object, frame} if a shape is fixed in a frame, else {object, update}.
import { box } from "./box.js";
import { cylinder } from "./cylinder.js";
import { damper } from "./damper.js";
import { mesh } from "./mesh.js";
import { plate } from "./plate.js";
import { sphere } from "./sphere.js";
import { spring } from "./spring.js";
import { steeringWheel } from "./steering_wheel.js";
import { tube } from "./tube.js";
import { wheel } from "./wheel.js";

/**
 * @typedef {object} Context
 * @property {import("../looks/materials.js").Materials} materials
 * @property {import("../scene/frames.js").Frames} frames poses as drawn while shapes are made
 * @property {Data} scene
 * @property {boolean} [rigid] shapes between frames keep their first form, except for a scale along their axes
 */

const MAKERS = { box, cylinder, damper, mesh, plate, sphere, spring, steering_wheel: steeringWheel, tube, wheel };

/**
 * Makes a shape.
 * @param {Data} shape of a scene
 * @param {Context} context
 * @returns {{object: import("three").Object3D, frame?: string, update?: Function, owned?: Data[], frames: string[], shape?: Data,
 *   stand?: (plane: number[] | null) => unknown} | null} stand: flattens a tyre on a plane in the axes of the frame;
 *   null for an unknown kind
 */
export function makeShape(shape, context) {
  const maker = MAKERS[shape.kind];
  if (maker === undefined) return null;
  const drawn = maker(shape, context);
  drawn.frames = [...new Set(drawn.frame !== undefined ? [drawn.frame] : (shape.points ?? shape.ends).map(([frame]) => frame))];
  return drawn;
}
