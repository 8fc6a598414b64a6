// The sound of an engine: tones without and with load, whose harmonics are half orders of the crankshaft speed.

/** Number of cylinders, which is the order of firing in harmonics of the working cycle. */
export const CYLINDERS = 4;
/** Amplitudes of the harmonics of the working cycle, from the first, without and with load. */
const CALM = [0.1, 0.16, 0.06, 1, 0.05, 0.12, 0.04, 0.5, 0.03, 0.06, 0.03, 0.22, 0, 0.03, 0, 0.1];
const LOADED = [0.16, 0.3, 0.14, 1, 0.16, 0.3, 0.14, 0.8, 0.1, 0.2, 0.1, 0.6, 0.08, 0.14, 0.08, 0.45, 0.05, 0.1, 0.05, 0.3, 0.03, 0.06, 0.03, 0.2];

/** Waveform of harmonics. @param {BaseAudioContext} context @param {number[]} orders amplitudes */
function wave(context, orders) {
  const [real, imaginary] = [new Float32Array(orders.length + 1), new Float32Array(orders.length + 1)];
  orders.forEach((strength, k) => {
    // Phases proportional to the square of the order avoid peaks, which would be clipped.
    const phase = (Math.PI * (k + 1) * (k + 1)) / orders.length;
    real[k + 1] = strength * Math.cos(phase);
    imaginary[k + 1] = strength * Math.sin(phase);
  });
  return context.createPeriodicWave(real, imaginary);
}

/**
 * Starts the tones of an engine.
 * @param {BaseAudioContext} context @param {AudioNode} to
 * @returns {{pitch: AudioParam[], calm: AudioParam, loaded: AudioParam}} pitch: of the working cycle, Hz
 */
export function engineVoice(context, to) {
  const voice = (orders) => {
    const tone = context.createOscillator();
    tone.setPeriodicWave(wave(context, orders));
    const level = context.createGain();
    level.gain.value = 0;
    tone.connect(level).connect(to);
    tone.start();
    return { pitch: tone.frequency, level: level.gain };
  };
  const [calm, loaded] = [voice(CALM), voice(LOADED)];
  return { pitch: [calm.pitch, loaded.pitch], calm: calm.level, loaded: loaded.level };
}
