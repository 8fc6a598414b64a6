// Finds the instants of a run at which part of a body may be lowest.

/**
 * Where positions of frames and amplitudes of flexible bodies are largest and smallest.
 * @param {import("./decode.js").Run} run with a scene
 * @returns {number[]} indices of times, ascending
 */
export function extremesOf({ scene, columns }) {
  const names = [...Object.values(scene.frames ?? {}).flatMap(({ position }) => position ?? []), ...(scene.flexible ?? []).flatMap(({ amplitudes }) => amplitudes)];
  const found = new Set();
  for (const name of names) {
    const data = columns[name]?.data ?? [];
    let [low, high] = [0, 0];
    for (let i = 1; i < data.length; i++) {
      if (data[i] < data[low] || Number.isNaN(data[low])) low = i;
      if (data[i] > data[high] || Number.isNaN(data[high])) high = i;
    }
    if (data.length > 0) found.add(low).add(high);
  }
  return [...found].sort((a, b) => a - b);
}
