// The audio graph of all sounds of a car, for an audio context that plays or renders to memory.
import { CYLINDERS, engineVoice } from "./engine_voice.js";
import { Thumps, noiseBuffer, noiseVoice, squealVoice, whineVoice } from "./voices.js";

/** Time constant of all changes, s, which avoids clicks. */
const TIME_CONSTANT = 0.025;
/** Time without new values after which the sound fades, s. */
const TIMEOUT = 0.4;

/**
 * Pitches, Hz, and levels of all sounds.
 * @typedef {{engine: {pitch: number, calm: number, loaded: number} | null, motor: {pitch: number, level: number} | null,
 *   squeal: {pitch: number, level: number}, rolling: {pitch: number, level: number}, wind: {pitch: number, level: number}, thumps: number[]}} Mix
 */

/** The graph of audio nodes. */
export class Mixer {
  /** @param {BaseAudioContext} context */
  constructor(context) {
    this.context = context;
    this.master = context.createGain();
    this.master.gain.value = 0;
    this.limiter = context.createDynamicsCompressor();
    this.master.connect(this.limiter).connect(context.destination);
    const noise = noiseBuffer(context);
    this.engine = engineVoice(context, this.master);
    this.whine = whineVoice(context, this.master);
    this.squeal = squealVoice(context, noise, this.master);
    this.rolling = noiseVoice(context, noise, this.master, "lowpass", 300, 0.4);
    this.wind = noiseVoice(context, noise, this.master, "bandpass", 700, 0.6);
    this.thumps = new Thumps(context, noise, this.master);
    this.volume = 1;
  }

  /** Changes the sounds to a mix. @param {Mix | null} mix null: silence */
  set(mix) {
    const now = this.context.currentTime;
    const to = (param, value) => param.setTargetAtTime(value, now, TIME_CONSTANT);
    const { gain } = this.master;
    gain.cancelScheduledValues(now);
    to(gain, mix === null ? 0 : 0.7 * this.volume);
    if (mix === null) return;
    gain.setTargetAtTime(0, now + TIMEOUT, 0.08);
    const { engine, motor, squeal, rolling, wind } = mix;
    if (engine !== null) for (const pitch of this.engine.pitch) to(pitch, engine.pitch / CYLINDERS);
    to(this.engine.calm, engine?.calm ?? 0);
    to(this.engine.loaded, engine?.loaded ?? 0);
    if (motor !== null) this.whine.pitch.forEach((pitch, k) => to(pitch, [1, 3][k] * motor.pitch));
    to(this.whine.level, motor?.level ?? 0);
    this.squeal.pitch.forEach((pitch) => to(pitch, squeal.pitch));
    to(this.squeal.level, 0.45 * squeal.level);
    for (const [voice, target] of [[this.rolling, rolling], [this.wind, wind]]) {
      to(voice.level, target.level);
      to(voice.pitch, target.pitch);
    } // prettier-ignore
    for (const strength of mix.thumps) this.thumps.knock(strength);
  }
}
