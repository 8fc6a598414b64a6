"""Roads of a run that differ from those of its model: road files, and roads moved by parameters."""

from collections.abc import Mapping

import numpy as np

from mbs.elements.road import KerbRoad, PlaneRoad, Road
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ParameterTarget, RoadType
from mbs.system.system import System


def run_roads(system: System, instance: Instance, files: Mapping[int, str]) -> dict[int, Road | str]:
    """Roads by their numbers; of a file its path.

    `instance`: with the values of the parameters; `files`: paths of files in place of roads; empty: none.
    """
    a = system.arrays
    roads: dict[int, Road | str] = {k: path for k, path in files.items() if path}
    if not len(a["road_type"]):
        return roads
    real = np.array(a["road_real"])
    values = [instance.get_parameter(k) for k in range(len(a["par_value"]))]
    for k in np.flatnonzero(np.array(values) != a["par_value"]):
        for n in range(a["par_ptr"][k], a["par_ptr"][k + 1]):
            if a["par_target"][n] == ParameterTarget.ROAD:
                offset = a["par_offset"][n] if len(a["par_offset"]) else 0.0
                real[a["par_index"][n]] = values[k] * a["par_scale"][n] + offset
    for road, kind in enumerate(a["road_type"]):
        reals = slice(a["road_real_ptr"][road], a["road_real_ptr"][road + 1])
        if road in roads or np.array_equal(real[reals], a["road_real"][reals]):
            continue
        numbers = real[reals].tolist()
        if kind == RoadType.PLANE:
            roads[road] = PlaneRoad(*numbers)
        elif kind == RoadType.KERB:
            position, lower, step, side, *rest = numbers
            roads[road] = KerbRoad(position, step, lower, "before" if side > 0.0 else "after", *rest)
    return roads
