"""Kinematics against the car in motion: a slow heave, roll and lock to lock on frictionless ground by the engine."""

from functools import cache

import numpy as np
import pytest

from benchmarks.car.rig import FIT_RANGES, HEAVE, simulate_motion, slope
from mbs.vehicle import load
from mbs.vehicle.kinematics.axle_measures import travel_measures, wheel_measures
from mbs.vehicle.linkages.continuation import HEAVE as BOTH
from mbs.vehicle.linkages.linkage import Linkage

EVERY = 100


@cache
def run(car, motion):
    return simulate_motion(load(car), motion)


@pytest.mark.parametrize(
    ("car", "axle", "motion"),
    [("prototype", "rear", "heave"), ("hatchback", "rear", "roll"), ("hatchback", "front", "steer")],
)
def test_the_car_in_motion_goes_through_the_same_positions(car, axle, motion):
    done, linkage = run(car, motion), Linkage(load(car), axle)
    names = [axle[0].upper() + side for side in "LR"]
    at, farthest = linkage.drawn, 0.0
    for k in range(0, len(done.t), EVERY):
        travel = np.array([done[f"wheel_{name}.travel"][k] for name in names])
        rack = float(done["steering_rack"][k]) if axle == "front" else 0.0
        at = linkage.solve(at.q, travel, rack)
        actual = wheel_measures(linkage, at)
        for name, side in zip(names, ("left", "right"), strict=True):
            assert actual[f"steer_angle_{side}"] == pytest.approx(done[f"wheel_{name}.steer"][k], abs=1e-7)
            assert actual[f"spring_length_{side}"] == pytest.approx(done[f"spring_{name}.length"][k], abs=1e-7)
            if motion != "roll":  # there the road leans against the chassis
                assert actual[f"inclination_angle_{side}"] == pytest.approx(
                    done[f"wheel_{name}.inclination"][k], abs=1e-7
                )
        farthest = max(farthest, abs(rack) if motion == "steer" else float(np.abs(travel).max()))
    assert farthest > 0.025


def test_the_wheel_rate_is_that_of_the_loads_on_the_ground():
    """Within what the rig has besides: gravity on the parts as they turn."""
    done = run("prototype", "heave")
    for axle, name in (("front", "FL"), ("rear", "RL")):
        linkage = Linkage(load("prototype"), axle)
        measured = slope(done[f"wheel_{name}.travel"], done[f"wheel_{name}.Fz"], FIT_RANGES["travel"])
        actual = travel_measures(linkage, linkage.drawn, BOTH)
        assert actual["wheel_rate_left"] == pytest.approx(measured, rel=0.012)
    assert HEAVE == 0.04
