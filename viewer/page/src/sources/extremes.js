// Finds instants of a run at which some part of a body may be at its lowest.

/**
 * Instants at which positions of frames or amplitudes of flexible bodies are largest or smallest.
 * @param {import("./decode.js").Run} run with a scene
 * @returns {number[]} indices of times, ascending
 */
export function extremesOf({ scene, columns }) {
  const names = [...Object.values(scene.frames ?? {}).flatMap(({ position }) => position ?? []), ...(scene.flexible ?? []).flatMap(({ amplitudes }) => amplitudes)];
  const indices = new Set();
  for (const name of names) {
    const data = columns[name]?.data ?? [];
    let [low, high] = [0, 0];
    for (let i = 1; i < data.length; i++) {
      if (data[i] < data[low] || Number.isNaN(data[low])) low = i;
      if (data[i] > data[high] || Number.isNaN(data[high])) high = i;
    }
    if (data.length > 0) indices.add(low).add(high);
  }
  return [...indices].sort((a, b) => a - b);
}
