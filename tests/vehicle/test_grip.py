"""The forces in a car file set the grip, and what `ali3 car` and `ali3 build` print of it is what the tyres reach."""

import re

import numpy as np
import pytest

from ali3.command import main
from mbs.vehicle import load
from mbs.vehicle.summary import grip_row
from tests.elements.tmeasy import forces

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
def test_the_grip_is_that_of_the_tyres():
    car, axle = load("hatchback"), "rear"
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
    assert told(variants[4], "front") == told(car, "front")


def test_the_command_prints_it(capsys):
    assert main(["car", "saloon"]) == 0
    printed = capsys.readouterr().out
    for axle in ("front", "rear"):
        row, text = grip_row(load("saloon"), axle)
        assert re.search(rf"^{row} +{re.escape(text)}$", printed, re.M)
