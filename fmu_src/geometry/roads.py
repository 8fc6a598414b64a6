"""Roads of a scene, each with the parameters of the FMU that move it or exchange its file."""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from fmu_src.variables.text_variables import ROADS
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.header.enumerations import ParameterTarget, RoadType

NUMBERS = {road.type: road.real_names for road in (PlaneRoad, KerbRoad, GridRoad)}
"""Names of the numbers of a road in the System, by its type."""
MOVED = {"kerb_x": "position", "kerb_height": "step", "friction": "friction", "friction_factor": "friction_factor"}
"""What a host may change, by its key in the drawing: the number of the road in the System."""


def with_parameters(
    roads: Sequence[Mapping[str, Any]], system: mbs.System, numbers_of_fmu: Collection[str]
) -> list[dict[str, Any]]:
    """Roads as a host may change them.

    `roads`: of the drawing; the first are those of the System in its order, or have their numbers;
    `numbers_of_fmu`: names of the FMU's variables that are numbers. Result: with `variables`, the parameters by what
    they set: the keys of `MOVED` and `file`; paths are those in the FMU.
    """
    files = {entry["road"]: entry["name"] for entry in system.meta.get("road_files", ())}
    values, changed = system.arrays["road_parameter"], []
    for index, drawn in enumerate(roads):
        road, number = dict(drawn), drawn.get("number", index)
        is_file = road["kind"] == "file"
        if is_file and road.get("path"):
            road["path"] = f"{ROADS}/{Path(road['path']).name}"
        variables = {}
        for key, real in _moved_reals(system, number).items():
            parameter = _parameter_that_writes(system, real)
            if parameter in numbers_of_fmu:
                variables[key] = parameter
                if key == MOVED[key] and not is_file:
                    road[key] = float(values[real])
        if number in files and not is_file:
            variables["file"] = files[number]
        changed.append(road | ({"variables": variables} if variables else {}))
    return changed


def _moved_reals(system: mbs.System, road: int) -> dict[str, int]:
    """Indices in `road_parameter` of the numbers of a road that a host may change, by the keys of `MOVED`."""
    if road >= len(system.arrays["road_type"]):
        return {}
    names = NUMBERS.get(RoadType(int(system.arrays["road_type"][road])), ())
    first = int(system.arrays["road_parameter_ptr"][road])
    return {key: first + names.index(name) for key, name in MOVED.items() if name in names}


def _parameter_that_writes(system: mbs.System, real: int) -> str | None:
    """Name of the parameter that is written without a factor to an entry of `road_parameter`; None if there is none."""
    a = system.arrays
    is_written = (a["par_target"] == ParameterTarget.ROAD) & (a["par_index"] == real) & (a["par_scale"] == 1.0)
    if not is_written.any():
        return None
    owner = np.searchsorted(a["par_ptr"], np.argmax(is_written), side="right") - 1
    return str(system.meta["parameters"][owner]["name"])
