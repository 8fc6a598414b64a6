"""What answers at the four road ports of a car add to a step through FMPy, in instructions."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np

from benchmarks.car.road_port_steps import FRICTION, height
from benchmarks.shared.instructions import instructions
from benchmarks.shared.pages import Row
from hosts.fmu.built_fmu import fmu_of_car
from hosts.fmu.fmu import unpack
from mbs.elements.road import GridRoad
from mbs.roads import write_road

ROADS = {"level": 0.0, "waves of 30 mm, 2 m long": 0.015}  # m, amplitude; of its own a plane and a file
COLUMNS = {"road": "", "own road": ",d", "four answers": ",d", "ratio": ".2f"}


def measure(car: str, steps: int, folder: Path) -> list[Row]:
    """Instructions a step of 2 ms through FMPy on each of `ROADS`: a loop of outputs, answers, inputs, step.

    `car`: as `hosts.fmu.built_fmu.fmu_of_car` takes it; `steps`: counted, after as many that are not. Raises
    `RuntimeError`: there is no valgrind.
    """
    own, ported = folder / "own", folder / "ported"
    for place, ports in ((own, None), (ported, "road")):
        unpack(fmu_of_car(car, lambda line: print(line, file=sys.stderr), ports=ports), place)
    rows: list[Row] = []
    for name, amplitude in ROADS.items():
        file = folder / "waves.road" if amplitude else ""
        if file:
            x = np.arange(-10.0, 40.0, 0.02)
            heights = np.repeat([[height(float(each), amplitude)] for each in x], 2, axis=1)
            write_road(GridRoad((-10.0, -5.0), (0.02, 10.0), heights, FRICTION), file)
        counts = [_a_step(place, road, steps) for place, road in ((own, file), (ported, amplitude))]
        row = {"own road": counts[0], "four answers": counts[1], "ratio": counts[1] / counts[0]}
        rows.append({"road": name} | row)
    return rows


def _a_step(place: Path, road: Path | str | float, steps: int) -> int:
    """Instructions of a step, by those of twice as many steps less those of the first."""
    counts = []
    for many in (steps, 2 * steps):
        os.environ["PYTHONHASHSEED"] = "0"  # else the dictionaries of Python are others each time
        command = [sys.executable, "-m", "benchmarks.car.road_port_steps", str(place), str(road), str(many)]
        found = instructions(command)
        if found is None:
            raise RuntimeError("Instructions are counted by valgrind, which is not installed.")
        counts.append(found)
    return round((counts[1] - counts[0]) / steps)
