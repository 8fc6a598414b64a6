// Pictures side by side, each of a running FMU or of a recording.
import { SceneView } from "../scene/scene_view.js";
import { Effects } from "../effects/car_effects.js";
import { el } from "../common/dom.js";
import { Instruments } from "../instruments/index.js";
import { Timing } from "../instruments/timing.js";
import { movedRoads } from "./roads.js";

/** Number of sampled times of a run. */
const SAMPLE_COUNT = 40;
/** Time of the run after which it is not sampled again, so that cameras stay, s. */
const LAST_SURVEY = 20;

export class Stage {
  /**
   * @param {Data[]} items `{title, scene, sample, variables}` of an FMU, or `{title, scene, sample, recording}`; `sample`
   *   returns the values at a time.
   * @param {{look: Data, notices: import("../common/notices.js").Notices, box: HTMLElement}} page current look;
   *   notices; parent element of the pictures.
   */
  constructor(items, { look, notices, box }) {
    this._notices = notices;
    this._look = look;
    this._epoch = 0;
    this._surveyed = 0;
    /** @type {Data[]} items with their elements, views and effects */
    this.parts = items.map(addElements);
    box.append(...this.parts.map(({ element }) => element));
    this._options = { driven: true, onMessage: (sentence) => notices.note(sentence) };
  }

  /** Creates the views, once the element is in the page. */
  open() {
    for (const part of this.parts) {
      part.road ??= "";
      part.view = new SceneView(part.holder, part.scene, this._options);
      part.view.set(this._look);
    }
    for (const part of this.parts) this._addEffects(part);
    this.problem = this.parts.map((part) => part.view.problem).find(Boolean) ?? "";
  }

  /** Chooses the roads of a value of the parameter `road.file`. */
  chooseRoads(name) {
    for (const part of this.parts) if (part.roads?.[name]) part.road = name;
  }

  /** Creates marks, dust and sound of a car. */
  _addEffects(part) {
    if (part.view.problem || !part.variables) return;
    part.effects?.dispose();
    const { variables } = part;
    const constants = [...variables.values()].filter((v) => v.variability === "constant").map((v) => [v.name, Number(v.start)]);
    part.effects = new Effects(part.view, { columns: [...variables.keys()], constants: Object.fromEntries(constants) }, (sentence) => this._notices.tell(sentence));
    part.effects.sound.mute(this._muted ?? false);
    if (this._soundOn) this.sound();
  }

  /** Starts the sound of the first picture, after a click or key as browsers require. */
  sound() {
    this._soundOn = true;
    this.parts[0].effects?.start();
  }

  /** @param {boolean} on */
  mute(on) {
    this._muted = on;
    for (const { effects } of this.parts) effects?.sound.mute(on);
  }

  /** Interrupts marks and trails, at another run or an earlier time. @param {boolean} [begun] another run */
  renew(begun = false) {
    if (begun) this._surveyed = 0;
    this._epoch += 1;
    for (const { instruments } of this.parts) instruments?.plan.trail.lift();
  }

  /** Draws the roads of a part anew if parameters have changed them. */
  _drawRoads(part, lookup) {
    if (part.view.problem || !part.variables) return;
    const { roads, key } = movedRoads(part.roads?.[part.road] ?? part.scene.roads ?? [], lookup);
    const drawn = `${part.road} ${key}`;
    if (part.drawn === drawn) return;
    const first = part.drawn === undefined && JSON.stringify(roads) === JSON.stringify(part.scene.roads ?? []);
    part.drawn = drawn;
    if (!first) this._replaceView(part, roads);
  }

  /** Draws a part anew on other roads. @param {Data} part @param {Data[]} roads */
  _replaceView(part, roads) {
    const camera = part.view.cameras?.name;
    part.view.dispose();
    const isOtherRoad = part.world && part.road !== part.world.road;
    part.view = new SceneView(part.holder, { ...part.scene, roads, ...(isOtherRoad ? { scenery: [] } : {}) }, this._options);
    this._addEffects(part);
    if (camera && !part.view.problem) part.view.camera(camera);
    part.view.set(this._look);
  }

  /**
   * Samples the run for the ranges of arrows and stress and the region of fixed cameras, each time it is twice as long.
   */
  survey([begin, end]) {
    if (end < 2 * this._surveyed || this._surveyed > LAST_SURVEY || !(end > begin)) return;
    this._surveyed = Math.max(0.25, end);
    const times = Array.from({ length: SAMPLE_COUNT }, (_, i) => begin + (i / (SAMPLE_COUNT - 1)) * (end - begin));
    for (const part of this.parts) {
      const { recording: run } = part;
      const instants = run ? times.map((_, i) => run.t[0] + (i / (SAMPLE_COUNT - 1)) * (run.t.at(-1) - run.t[0])) : times;
      part.view.scan((i) => part.sample(instants[i]), SAMPLE_COUNT);
    }
  }

  /** Updates the pictures to a time. */
  show(time, pace) {
    for (const part of this.parts) {
      const lookup = part.sample(time);
      this._drawRoads(part, lookup);
      part.view.update(lookup);
      part.effects?.update(lookup, time, this._epoch);
      const end = part.recording ? part.recording.t[part.recording.t.length - 1] : Infinity;
      const warning = part.timing.show(Math.min(time, end), part.recording ? null : pace);
      if (!part.recording) this._notices.flag("behind", warning, { bad: true });
      part.instruments?.show(lookup);
      if (part.recording?.end) this._notices.flag(`end ${part.title}`, time > end ? `${part.title}: ${part.recording.end}` : "");
    }
  }

  /** Draws the pictures. */
  render() {
    for (const part of this.parts) part.view.render();
  }

  dispose() {
    for (const part of this.parts) {
      part.effects?.dispose();
      part.view?.dispose();
    }
  }
}

/** An item with its element: picture, instruments of a car, times. @param {Data} item */
function addElements(item) {
  const { title, scene, variables, recording } = item;
  const outputs = [...(variables?.values() ?? [])].filter((v) => v.causality === "output").map((v) => v.name);
  const names = new Set(variables ? outputs : Object.keys(recording?.columns ?? {}));
  const holder = el("div.a3-picture");
  const timing = new Timing(title);
  const instruments = Instruments.of(names) ? new Instruments(names, { scene, fixed: (name) => variables?.get(name)?.start }) : null;
  const element = el("div.a3-view", {}, holder, ...(instruments ? [instruments.layer()] : []), timing.element);
  return { ...item, holder, timing, instruments, element };
}
