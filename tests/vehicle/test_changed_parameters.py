"""Every parameter of a car's FMU, set to another value, gives the run of a car that is built from a file with it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import fmpy
import pytest

import mbs
from fmu_src.build.build import build_fmu
from mbs.vehicle import load
from tests.changed_parameters import SAME, Change, changes
from tests.quick import quick

CARS = ("prototype", "hatchback", "saloon", "commonroad_escort")
MORE = 10.0  # kg
KERB = {"road.kerb_x": ("position", 3.0), "road.kerb_height": ("step", 0.05)}
"""Numbers of the default road that are in no file."""
VALUES: dict[str, float] = {name: value for name, (_, value) in KERB.items()} | {
    "drive.max_power": 3e3,
    "drive.max_torque": 30.0,
    "drive.regeneration_power": 1.5e3,
    **{f"{axle}.tyre.{factor}": 0.8 for axle in ("front", "rear") for factor in ("lmux", "lmuy", "lkx", "lky")},
}
"""Limits that a short run meets, and scaling factors with which the friction is one of tyres."""
NEAR = 2e-6
"""Difference of a run with another body or ratio, which begins with other round-off, from that of a car rebuilt."""
BODY = {
    "chassis.mass": 1.003,
    "chassis.com.": 0.002,
    "chassis.inertia.": 1.01,
    "chassis.products.": 1.0,
    "steering.rack_per_turn": 1.1,
    "front.alignment.": 0.01,
    "rear.alignment.": 0.01,
}
"""By the start of the name: a factor, or what is added; the frame of a car allows no more."""
MANOEUVRES: dict[str, dict[str, Any]] = {
    "bend": {
        "inputs": {
            "steering": lambda t: 0.3 if t > 0.1 else 0.0,
            "throttle": lambda t: 0.7 if t < 0.6 else 0.0,
            "brake": lambda t: 0.5 if t > 0.9 else 0.0,
        },
        "pose": mbs.Pose(speed=12.0),
        "t_end": 1.2,
    },
    "from rest": {
        "inputs": {"throttle": lambda t: 1.0 if t > 0.4 else 0.0, "hand_brake": lambda t: 1.0 if t > 0.8 else 0.0},
        "pose": None,
        "t_end": 1.4,
    },
}


def rebuilt(car: Any) -> Callable[[Mapping[str, float]], mbs.System]:
    """A car from the changed file; of the road of tests the kerb, which no file has."""

    def build(values: Mapping[str, float]) -> mbs.System:
        changed = car.changed({n: v for n, v in values.items() if n not in KERB})
        kerb = {KERB[n][0]: v for n, v in values.items() if n in KERB}
        if not kerb:
            return mbs.compile(changed.model())
        road = replace(changed.road.default(), **kerb)
        return mbs.compile(changed.model(replace(road, lower_height=-road.step)))

    return build


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mbs.ParameterWarning")  # values far from those of the car, to be seen
@pytest.mark.parametrize("name", quick({"prototype", "hatchback"}, CARS, "proof"))
def test_an_fmu_with_a_changed_parameter_is_a_car_rebuilt(name: str, tmp_path: Path) -> None:
    car = load(name)
    system = mbs.compile(car.model())
    fmu = build_fmu(system, name, tmp_path, [fmpy.platform])
    entries = system.meta["parameters"]
    left = [p["name"] for p in entries]
    # a file with a heavy payload is refused, since its centre of mass is not where the file says
    values = VALUES | {p["name"]: p["value"] + MORE for p in entries if p["name"].startswith("payload.")}
    body = {
        p["name"]: p["value"] * by if by > 1.0 else p["value"] + by
        for p in entries
        for begin, by in BODY.items()
        if p["name"].startswith(begin)
    }
    left = [name for name in left if name not in body or name in values]
    count, actual = len(left), list[Change]()
    for manoeuvre in MANOEUVRES.values():
        known = {i["name"] for i in system.meta["inputs"]}
        inputs = {n: at for n, at in manoeuvre["inputs"].items() if n in known}
        plan = {**manoeuvre, "inputs": inputs}
        actual += changes(system, rebuilt(car), names=left, fmu=fmu, values=values, **plan)
        left = [c.name for c in actual if not any(d.effect for d in actual if d.name == c.name)]
        left = list(dict.fromkeys(left))
    plan = MANOEUVRES["bend"]
    moved = changes(system, rebuilt(car), names=list(body), fmu=fmu, values=body, same=NEAR, **plan)
    assert {c.name: (c.difference, c.fmu) for c in moved if c.difference > NEAR or c.fmu != 0.0} == {}
    assert {c.name for c in moved} == set(body)
    assert min(c.effect for c in moved) > 100.0 * NEAR
    assert {c.name: c.difference for c in actual if c.difference > SAME} == {}
    assert {c.name: c.fmu for c in actual if c.fmu != 0.0} == {}
    hidden = {"road.kerb_height"} if car.aerodynamics.drag_area else {"road.kerb_height", "aerodynamics.air_density"}
    assert set(left) <= hidden, "no manoeuvre shows them"
    assert len({c.name for c in actual}) == count
