"""The forces in a car file set the grip, and what `ali3 car` and `ali3 build` print of it is what the tyres reach."""

import re

import numpy as np
import pytest

from ali3.command import main
from mbs import Pose, compile
from mbs.vehicle import car_names, load
from mbs.vehicle.summary import grip_row
from tests.elements.tmeasy import direction, forces
from tests.vehicle.hatchback import drive

BOTH = ["longitudinal", "lateral"]
FORCES = ("slope", "max_force", "slide_force")


def told(car, axle):
    name, text = grip_row(car, axle)
    assert name == f"{axle} grip"
    longitudinal, lateral, scale = map(
        float, re.match(r"([\d.]+) longitudinal, ([\d.]+) lateral: .* file times ([\d.]+),", text).groups()
    )
    return longitudinal, lateral, scale


def larger(car, axle, directions, factor):
    """The car with larger forces in the file of its tyres."""
    curves = {d: getattr(getattr(car, axle).tyre, d) for d in directions}
    return car.changed(
        {
            f"{axle}.tyre.{d}.{key}.{k}": factor * getattr(curve, key)[k]
            for d, curve in curves.items()
            for key in FORCES
            for k in range(2)
        }
    )


def reached(car, axle):
    """Largest forces over the nominal load, by the second transcription of the tyre."""
    tyre = getattr(car, axle).tyre.tyre()
    friction = car.road.friction * car.road.friction_factor
    slips = np.linspace(1e-3, 2.0, 4000)
    return [
        max(abs(forces(tyre, tyre.nominal_load, friction, s * x, s * y)[k]) for s in slips) / tyre.nominal_load
        for k, (x, y) in enumerate(((1.0, 0.0), (0.0, 1.0)))
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "axle"), [("prototype", "front"), ("hatchback", "rear")])
def test_the_grip_is_that_of_the_tyres(name, axle):
    car = load(name)
    variants = [
        car,
        car.changed({"road.friction": 0.4, f"{axle}.tyre.grip": 1.2}),
        car.changed({"road.friction_factor": 0.5}),
        larger(car, axle, ["longitudinal"], 1.2),
        larger(car, axle, BOTH, 1.2),
    ]
    for one in variants:
        assert told(one, axle)[:2] == pytest.approx(reached(one, axle), rel=1e-3)
    before = told(car, axle)
    both, ahead = told(variants[4], axle), told(variants[3], axle)
    assert both == pytest.approx((1.2 * before[0], 1.2 * before[1], before[2]), rel=1e-3)
    assert ahead == pytest.approx((1.2 * before[0], *before[1:]), rel=1e-3)
    other = "rear" if axle == "front" else "front"
    assert told(variants[4], other) == told(car, other)


@pytest.mark.parametrize("name", car_names())
def test_the_command_prints_it(name, capsys):
    assert main(["car", name]) == 0
    printed = capsys.readouterr().out
    for axle in ("front", "rear"):
        row, text = grip_row(load(name), axle)
        assert re.search(rf"^{row} +{re.escape(text)}$", printed, re.M)


def at_the_limit(car):
    """Largest lateral acceleration of a turn that narrows from 22 m/s on, and then the lateral force of the front tyres
    and the largest that the second transcription gives for their loads."""
    turn = {"steering": lambda t: 0.05 * t, "throttle": 0.25}
    run = drive(8.0, 0.005, turn, pose=Pose(speed=22.0), of=compile(car.model()))
    k = int(np.argmax(run["chassis.ay"]))
    tyre, wheels = car.front.tyre.tyre(), ("wheel_FL", "wheel_FR")
    most = sum(direction(tyre, "lateral", run[f"{w}.Fz"][k], car.road.friction).FM for w in wheels)
    return run["chassis.ay"][k], sum(run[f"{w}.Fy"][k] for w in wheels), most


@pytest.mark.slow
def test_curves_of_more_force_raise_the_lateral_limit():
    """The hatchback's front tyres slide first, so that their largest forces are its limit."""
    car = load("hatchback")
    front = larger(car, "front", BOTH, 1.2)
    before, ahead = at_the_limit(car), at_the_limit(larger(larger(car, "front", BOTH[:1], 1.2), "rear", BOTH[:1], 1.2))
    all_larger, front_larger = at_the_limit(larger(front, "rear", BOTH, 1.2)), at_the_limit(front)
    for _, force, most in (before, ahead, all_larger, front_larger):
        assert force == pytest.approx(most, rel=0.01)
    assert 1.17 < all_larger[2] / before[2] < 1.2  # the load that moves to the outer wheels takes some of the 20 %
    assert all_larger[0] / before[0] == pytest.approx(all_larger[2] / before[2], rel=0.02)
    assert ahead[0] == pytest.approx(before[0], rel=1e-3)
    assert front_larger[0] > 1.12 * before[0]
