"""The grip that `ali3 car` and `ali3 build` print is what the tyres reach."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ali3.command import main
from mbs.vehicle import car_names, load
from mbs.vehicle.summary import grip_row
from tests.elements.tmeasy import forces

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


@pytest.mark.parametrize("axle", ["front", "rear"])
@pytest.mark.parametrize("name", car_names())
def test_it_is_what_the_tyres_reach(name, axle):
    car = load(name)
    variants = [
        car,
        car.changed({"road.friction": 0.4, f"{axle}.tyre.grip": 1.2}),
        car.changed({"road.friction_factor": 0.5}),
        larger(car, axle, ["longitudinal"], 1.2),
        larger(car, axle, ["longitudinal", "lateral"], 1.2),
    ]
    for one in variants:
        assert told(one, axle)[:2] == pytest.approx(reached(one, axle), rel=1e-3)
    before = told(car, axle)
    both, ahead = told(variants[4], axle), told(variants[3], axle)
    assert both[:2] == before[:2]
    assert both[2] == pytest.approx(before[2] / 1.2, rel=1e-3)
    assert ahead[:2] == pytest.approx((before[0], before[1] / 1.2), rel=1e-3)


@pytest.mark.parametrize("name", car_names())
def test_the_command_prints_it(name, capsys):
    assert main(["car", name]) == 0
    printed = capsys.readouterr().out
    for axle in ("front", "rear"):
        row, text = grip_row(load(name), axle)
        assert re.search(rf"^{row} +{re.escape(text)}$", printed, re.M)
