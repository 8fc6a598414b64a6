// The synthesised sound of a driven car.
import { CarMix } from "./mix.js";
import { Mixer } from "./mixer.js";

const NO_AUDIO = "This browser gives no sound (Web Audio), so the car is silent; everything else goes on.";

function loudspeakers() {
  const Context = globalThis.AudioContext ?? globalThis.webkitAudioContext;
  return new Context({ latencyHint: "interactive" });
}

/** Sound of a car from its columns; starts after a click, as browsers require. */
export class CarSound {
  _muted = false;

  /**
   * @param {object} car
   * @param {string[]} car.columns names of its signals
   * @param {Object<string, number>} [car.constants] of the FMU
   * @param {AudioContext | OfflineAudioContext} [car.context] output; by default the loudspeakers
   */
  constructor({ columns, constants = {}, context = undefined }) {
    this.context = context;
    this.mix = new CarMix(columns, constants);
    /** Reason why nothing is audible; empty if there is sound. */
    this.problem = this.mix.problem;
    this.mixer = null;
  }

  /** Starts the sound; called by each click or key. @returns {Promise<void>} */
  async start() {
    if (this.problem && this.mixer === null) return;
    try {
      if (this.mixer === null) {
        this.context ??= loudspeakers();
        this.mixer = new Mixer(this.context);
        this.mixer.volume = this._muted ? 0 : 1;
      }
      if (this.context.state === "suspended" && !("startRendering" in this.context)) await this.context.resume();
    } catch {
      this.problem = NO_AUDIO;
      this.mixer = null;
    }
  }

  /**
   * Sets the sound; without new values, or while time stands, it fades.
   * @param {((name: string) => number | undefined) | null} lookup null: silence
   * @param {number} [time] of the run, s; by default of the clock
   */
  update(lookup, time = performance.now() / 1000) {
    if (this.mixer === null) return;
    this.mixer.set(lookup === null ? null : this.mix.at(lookup, time));
  }

  /** @param {boolean} on */
  mute(on) {
    this._muted = on;
    if (this.mixer !== null) this.mixer.volume = on ? 0 : 1;
  }

  /** Ends the sound and releases the device. @returns {Promise<void>} */
  async dispose() {
    this.mixer = null;
    if (this.context !== undefined && "close" in this.context && this.context.state !== "closed") await this.context.close();
  }
}
