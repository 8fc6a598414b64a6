// Applies parameters of the FMU to the roads of a picture.

/**
 * Roads with the friction and kerbs that parameters set; the higher side of a kerb keeps its height.
 * @param {Data[]} roads of a scene; `variables` names the parameters
 * @param {(name: string) => number | undefined} lookup
 * @returns {{roads: Data[], key: string}} `key` changes with the appearance.
 */
export function movedRoads(roads, lookup) {
  const key = [];
  const moved = roads.map((road) => {
    const { kerb_x: along, kerb_height: high, ...grip } = road.variables ?? {};
    const changed = { ...road };
    for (const name of ["friction", "friction_factor"]) {
      const value = grip[name] && lookup(grip[name]);
      if (Number.isFinite(value)) key.push((changed[name] = value));
    }
    if (road.kind !== "profile" || road.heights.length !== 2 || !(along || high)) return changed;
    const [x, height] = [along && lookup(along), high && lookup(high)];
    if (Number.isFinite(x)) changed.origin = [x, ...(road.origin ?? [0, 0, 0]).slice(1)];
    if (Number.isFinite(height)) {
      const [first, last] = road.heights;
      const top = Math.max(first, last);
      changed.heights = first < last ? [top - height, top] : [top, top - height];
    }
    key.push(x, height);
    return changed;
  });
  return { roads: moved, key: key.join(" ") };
}
