// Tyre marks, dust and sound of the car, as far as this computer supports them.
import { Dust } from "./dust.js";
import { CarSound } from "./sound/car_sound.js";
import { TyreMarks } from "./tyre_marks.js";

/** The effects of a picture. */
export class Effects {
  /**
   * @param {import("../scene/scene_view.js").SceneView} view
   * @param {{columns: string[], constants: Object<string, number>}} car
   * @param {(sentence: string) => void} tell receives problems
   */
  constructor(view, car, tell) {
    this._tell = tell;
    this.drawn = [new TyreMarks(view, car), new Dust(view, car)];
    this.sound = new CarSound(car);
  }

  /** Starts the sound, after a click or key as browsers require. */
  async start() {
    await this.sound.start();
    if (this.sound.problem) this._tell(this.sound.problem);
  }

  /** Updates the effects; called after the view is updated and before it is drawn. @param {(name: string) => number} lookup @param {number} time s @param {number} epoch */
  update(lookup, time, epoch) {
    for (const effect of this.drawn) effect.update(lookup, time, epoch);
    this.sound.update(lookup, time);
  }

  dispose() {
    for (const effect of [...this.drawn, this.sound]) effect.dispose();
  }
}
