"""Roads of a run that differ from those of its model: road files and roads changed by parameters."""

from collections.abc import Mapping

import numpy as np

from mbs.elements.road import KerbRoad, PlaneRoad, Road
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ParameterTarget, RoadType
from mbs.system.system import System


def changed_roads(system: System, instance: Instance, files: Mapping[int, str]) -> dict[int, Road | str]:
    """Changed roads by their numbers; a road file as its path.

    `instance`: has the values of the parameters; `files`: paths of road files by the number of the road they replace,
    an empty path for none.
    """
    arrays = system.arrays
    roads: dict[int, Road | str] = {k: path for k, path in files.items() if path}
    if not len(arrays["road_type"]):
        return roads
    real = np.array(arrays["road_real"])
    values = [instance.get_parameter(k) for k in range(len(arrays["par_value"]))]
    for k in np.flatnonzero(np.array(values) != arrays["par_value"]):
        for n in range(arrays["par_ptr"][k], arrays["par_ptr"][k + 1]):
            if arrays["par_target"][n] == ParameterTarget.ROAD:
                offset = arrays["par_offset"][n] if len(arrays["par_offset"]) else 0.0
                real[arrays["par_index"][n]] = values[k] * arrays["par_scale"][n] + offset
    for road, kind in enumerate(arrays["road_type"]):
        reals = slice(arrays["road_real_ptr"][road], arrays["road_real_ptr"][road + 1])
        if road in roads or np.array_equal(real[reals], arrays["road_real"][reals]):
            continue
        numbers = real[reals].tolist()
        if kind == RoadType.PLANE:
            roads[road] = PlaneRoad(*numbers)
        elif kind == RoadType.KERB:
            position, lower, step, side, *rest = numbers
            roads[road] = KerbRoad(position, step, lower, "before" if side > 0.0 else "after", *rest)
    return roads
