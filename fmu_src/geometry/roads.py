"""Roads of a scene with the parameters of the FMU that move or exchange them."""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import mbs
from fmu_src.variables.text_variables import ROADS
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.header.enumerations import RoadType

NUMBERS = {road.type: road.real_names for road in (PlaneRoad, KerbRoad, GridRoad)}
MOVED = {"kerb_x": "position", "kerb_height": "step", "friction": "friction", "friction_factor": "friction_factor"}
TARGET_ROAD = 2


def with_parameters(
    roads: Sequence[Mapping[str, Any]], system: mbs.System, numbers_of_fmu: Collection[str]
) -> list[dict[str, Any]]:
    """Roads as a host may change them.

    `roads`: of the drawing; the first are those of the System in its order, or have their numbers;
    `numbers_of_fmu`: names of the FMU's variables that are numbers. Result: with `variables`, the parameters by what
    they set: the keys of `MOVED` and `file`; paths are those in the FMU.
    """
    files = {entry["road"]: entry for entry in system.meta.get("road_files", ())}
    entries = []
    for index, road in enumerate(roads):
        changed_road, k = dict(road), road.get("number", index)
        if changed_road["kind"] == "file" and changed_road.get("path"):
            changed_road["path"] = f"{ROADS}/{Path(changed_road['path']).name}"
        variables = {}
        if k < len(system.arrays["road_type"]):
            first_number = int(system.arrays["road_real_ptr"][k])
            numbers = NUMBERS.get(RoadType(int(system.arrays["road_type"][k])), ())
            for name, number in MOVED.items():
                real_index = first_number + numbers.index(number) if number in numbers else -1
                parameter = _parameter_of(system, real_index)
                if parameter in numbers_of_fmu:
                    variables[name] = parameter
                    if name == number and changed_road["kind"] != "file":
                        changed_road[name] = float(system.arrays["road_real"][real_index])
        if k in files and changed_road["kind"] != "file":
            variables["file"] = files[k]["name"]
        entries.append(changed_road | ({"variables": variables} if variables else {}))
    return entries


def _parameter_of(system: mbs.System, real: int) -> str:
    """The parameter that writes a number of the roads as it is; empty: none."""
    a = system.arrays
    for k in range(len(a["par_target"])):
        if int(a["par_target"][k]) == TARGET_ROAD and int(a["par_index"][k]) == real and a["par_scale"][k] == 1.0:
            owner = next(p for p in range(len(a["par_ptr"]) - 1) if a["par_ptr"][p] <= k < a["par_ptr"][p + 1])
            return str(system.meta["parameters"][owner]["name"])
    return ""
