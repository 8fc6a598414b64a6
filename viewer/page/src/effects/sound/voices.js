// The sounds of a car except its engine: gear whine, tyre squeal, rolling, wind, impacts.
import { randomNumbers } from "../../common/random.js";

/** White noise of two seconds. @param {BaseAudioContext} context @returns {AudioBuffer} */
export function noiseBuffer(context) {
  const buffer = context.createBuffer(1, 2 * context.sampleRate, context.sampleRate);
  const next = randomNumbers(2718);
  const samples = buffer.getChannelData(0);
  for (let k = 0; k < samples.length; k++) samples[k] = 2 * next() - 1;
  return buffer;
}

const silent = (context) => {
  const level = context.createGain();
  level.gain.value = 0;
  return level;
};

/** Noise through a filter. @returns {{level: AudioParam, pitch: AudioParam}} */
export function noiseVoice(context, noise, to, type, frequency, quality) {
  const source = context.createBufferSource();
  source.buffer = noise;
  source.loop = true;
  const filter = context.createBiquadFilter();
  Object.assign(filter, { type });
  filter.frequency.value = frequency;
  filter.Q.value = quality;
  const level = silent(context);
  source.connect(filter).connect(level).connect(to);
  source.start();
  return { level: level.gain, pitch: filter.frequency };
}

/** The whine of an electric motor: its fundamental and third harmonic. @returns {{level: AudioParam, pitch: AudioParam[]}} */
export function whineVoice(context, to) {
  const level = silent(context);
  const pitch = [1, 0.25].map((strength) => {
    const tone = context.createOscillator();
    const share = context.createGain();
    share.gain.value = strength;
    tone.frequency.value = 0;
    tone.connect(share).connect(level);
    tone.start();
    return tone.frequency;
  });
  level.connect(to);
  return { level: level.gain, pitch };
}

/** Squeal: a sawtooth tone and noise around its pitch. @returns {{level: AudioParam, pitch: AudioParam[]}} */
export function squealVoice(context, noise, to) {
  const level = silent(context);
  const tone = context.createOscillator();
  tone.type = "sawtooth";
  const bandpass = context.createBiquadFilter();
  Object.assign(bandpass, { type: "bandpass" });
  bandpass.Q.value = 4;
  const share = context.createGain();
  share.gain.value = 0.35;
  tone.connect(bandpass).connect(share).connect(level);
  const noiseBand = noiseVoice(context, noise, level, "bandpass", 900, 9);
  noiseBand.level.value = 1.6;
  tone.start();
  level.connect(to);
  return { level: level.gain, pitch: [tone.frequency, bandpass.frequency, noiseBand.pitch] };
}

/** Largest number of simultaneous impacts. */
const MAX_IMPACTS = 6;

/** Short low sounds of impacts. */
export class Thumps {
  _ends = [];

  /** @param {BaseAudioContext} context @param {AudioBuffer} noise @param {AudioNode} to */
  constructor(context, noise, to) {
    this.context = context;
    this.noise = noise;
    this.to = to;
  }

  /** Number of current impacts. */
  get count() {
    this._ends = this._ends.filter((end) => end > this.context.currentTime);
    return this._ends.length;
  }

  /** Plays an impact. @param {number} strength 0 to 1 */
  knock(strength) {
    if (this.count >= MAX_IMPACTS) return;
    const { context } = this;
    const [begin, end] = [context.currentTime, context.currentTime + 0.28];
    const level = silent(context);
    level.gain.setValueAtTime(0, begin);
    level.gain.linearRampToValueAtTime(0.9 * strength, begin + 0.006);
    level.gain.setTargetAtTime(0, begin + 0.006, 0.05);
    const tone = context.createOscillator();
    tone.frequency.setValueAtTime(105, begin);
    tone.frequency.exponentialRampToValueAtTime(48, end);
    const noiseSource = context.createBufferSource();
    noiseSource.buffer = this.noise;
    const lowpass = context.createBiquadFilter();
    lowpass.type = "lowpass";
    lowpass.frequency.value = 420;
    tone.connect(level);
    noiseSource.connect(lowpass).connect(level);
    level.connect(this.to);
    for (const source of [tone, noiseSource]) {
      source.start(begin);
      source.stop(end);
    }
    tone.onended = () => level.disconnect();
    this._ends.push(end);
  }
}
