"""Values with which no car works are told in Python too, and at the ends of the ranges that are told a car stands."""

import warnings
from functools import cache

import numpy as np
import pytest

from mbs import ParameterWarning, Pose, Simulation, compile, simulate
from mbs.vehicle import car_names, load
from mbs.vehicle.checks.working import SUNK, working_ranges

BAD = {
    "front.tyre.stiffness": (1e4, 2e6),
    "rear.spring.free_length": (0.05, 2.0),
    "rear.spring.factor": (0.1,),
    "rear.damper.factor": (0.0,),
    "brakes.torque": (30.0, 2e4),
}
WHEELS = ("FL", "FR", "RL", "RR")
system = cache(lambda name: compile(load(name).model()))


@pytest.mark.parametrize("name", [n for n in car_names() if load(n).front.tyre.kind == "tmeasy"])
def test_they_are_told_before_the_start_and_after_it(name):
    simulation, ranges = Simulation(system(name)), working_ranges(load(name))
    missing = []
    for path, values in BAD.items():
        low, high = ranges[path]
        for value in (v for v in values if not low <= v <= high):
            words = f"'{path}' is set to {value:g}"
            for act in (
                lambda path=path, value=value: simulation.set_parameter(path, value),
                lambda path=path, value=value: Simulation(system(name), parameters={path: value}),
            ):
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    act()
                told = [str(w.message) for w in caught if w.category is ParameterWarning and w.filename == __file__]
                range_told = f"with which no such model works; from {low:.4g} to {high:.4g}"
                if not any(words in line and range_told in line for line in told):
                    missing.append((words, told))
    assert missing == []
    assert all(ranges[path][0] <= load(name).values()[path] <= ranges[path][1] for path in BAD)


@pytest.mark.slow
@pytest.mark.parametrize("name", [n for n in car_names() if load(n).front.tyre.kind == "tmeasy"])
def test_at_the_ends_of_the_ranges_a_car_drives_over_a_kerb_on_its_wheels(name):
    bad, ranges, values = [], working_ranges(load(name)), load(name).values()
    inputs = {"brake": ([0.0, 1.2, 1.4, 3.0], [0.0, 0.0, 0.5, 0.5])}
    for path in ranges.keys() & values.keys():
        least, most = (next(p[k] for p in system(name).meta["parameters"] if p["name"] == path) for k in ("min", "max"))
        for value in np.clip(ranges[path], least, most):
            kerb = {path: float(value), "road.kerb_x": 8.0, "road.kerb_height": 0.05}
            start = Simulation(system(name)).sensors["chassis.z"]
            quiet = {"estimate_error": False, "progress": False}
            run = simulate(system(name), 3.0, 0.002, inputs, None, kerb, pose=Pose(speed=8.0), **quiet)
            if not np.abs(run["chassis.z"] - start).max() < SUNK + 0.15 or not np.abs(run["chassis.roll"]).max() < 0.5:
                bad.append((path, value, np.abs(run["chassis.z"] - start).max()))
    assert bad == []
