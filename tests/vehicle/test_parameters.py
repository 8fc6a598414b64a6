"""Every number of a car file that says it may change is a parameter of the FMU and does what the file would do."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from mbs import Pose, compile, simulate
from mbs.vehicle import car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changes import changed_content
from mbs.vehicle.section import sections_of

NOT_IN_THE_FILE = {"road.kerb_x", "road.kerb_height"}
H = 0.005  # s
SAME = 1e-9


@cache
def model(name):
    return load(name).model()


@cache
def system(name):
    return compile(model(name))


def key_paths():
    return [(name, path) for name in car_names() for path in load(name).values()]


def other(name, path):
    """A plausible value that is not that of the file."""
    q = quantity(name, path)
    value = load(name).values()[path]
    if path == "steering.by_torque":
        return 1.0 - value
    if value == 0.0:
        return q.low + 0.1 * (q.high - q.low)
    if path.endswith("_power"):
        return max(0.1 * value, q.low)  # a limit that so short a drive meets
    return 0.93 * value if 0.93 * value >= q.least else min(1.07 * value, q.high)


def quantity(name, path):
    table, _, field = path.rpartition(".")
    (section,) = (s for s in sections_of(load(name)) if s.path == table)
    return section.quantity(field)


def driven(compiled, parameters):
    """From rest and from 20 m/s: full throttle, coasting, brake, hand brake, a turn."""
    wanted = {
        "steering": lambda t: 0.15 * np.sin(3.0 * t),
        "throttle": lambda t: 1.0 if t < 0.3 else 0.0,
        "brake": lambda t: 0.0 if t < 0.45 else 0.4,
        "hand_brake": lambda t: 0.0 if t < 0.6 else 0.3,
    }
    inputs = {i["name"]: wanted[i["name"]] for i in compiled.meta["inputs"] if i["name"] in wanted}
    quiet = {"estimate_error": False, "progress": False}
    return [simulate(compiled, 0.7, H, inputs, None, parameters, pose=Pose(speed=v), **quiet) for v in (0.0, 20.0)]


@cache
def unchanged(name):
    return driven(system(name), None)


@pytest.mark.parametrize("name", car_names())
def test_every_number_that_may_change_is_tied_to_the_model(name):
    parameters = {p.name: p for p in model(name).parameters}
    assert set(parameters) - NOT_IN_THE_FILE == set(load(name).values())
    for path, value in load(name).values().items():
        q, p = quantity(name, path), parameters[path]
        assert (p.value, p.min, p.max, p.unit) == (value, q.least, q.high, q.unit)
        assert p.tunable == (q.change == "tunable"), path
        assert len(p.description) > 3


@pytest.mark.slow
@pytest.mark.parametrize(("name", "path"), key_paths())
def test_a_parameter_does_what_the_file_would_do(name, path):
    value = other(name, path)
    car = load(name)
    changed = car_from(changed_content(car._data, {path: value}, "x"), car.folder, "x", at_rest=False)
    rebuilt = driven(compile(changed.model()), None)
    tuned = driven(system(name), {path: value})
    as_it_was = unchanged(name)
    differs = False
    for then, now, before in zip(rebuilt, tuned, as_it_was, strict=True):
        for name_of in (s["name"] for s in system(name).meta["sensors"] if not s["name"].startswith("solver.")):
            scale = max(1.0, np.abs(then[name_of]).max())
            np.testing.assert_allclose(now[name_of], then[name_of], rtol=0.0, atol=SAME * scale, err_msg=name_of)
            differs |= np.abs(now[name_of] - before[name_of]).max() > SAME * scale
    assert differs, f"{path} changes nothing"
