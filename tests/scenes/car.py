"""The prototype car for its tests."""

from functools import cache

import numpy as np
import pytest

from mbs import compile, simulate
from mbs.elements.road import PlaneRoad
from mbs.scenes import prototype_car

WHEELS = ("FL", "FR", "RL", "RR")
NEUTRAL = {"drive.creep_torque": 0.0}
H = 0.01  # s
ON_ICE = pytest.mark.filterwarnings("ignore:Parameter 'road.friction' is set to 0:mbs.ParameterWarning")


@cache
def car():
    return compile(prototype_car.build())


@cache
def car_on_ice():
    """Without friction the horizontal tyre forces do not disturb the suspension."""
    return compile(prototype_car.build(PlaneRoad(friction=0.0)))


def drive(system, t_end, h=H, inputs=None, *, neutral=False, pose=None, every=1, parameters=None, estimate_error=False):
    parameters = (parameters or {}) | (NEUTRAL if neutral else {})
    more = {"every": every, "pose": pose, "estimate_error": estimate_error}
    return simulate(system, t_end, h, inputs, None, parameters, progress=False, **more)


def positions(trajectory):
    """Positions of the reference point, m, shape (n, 3)."""
    return np.array([trajectory[f"chassis.{c}"] for c in "xyz"]).T


def displacement(trajectory, begin, end):
    """Largest distance of the reference point from its position at `begin`, s, until `end`, s; m."""
    part = positions(trajectory)[(trajectory.t > begin - 1e-9) & (trajectory.t < end + 1e-9)]
    return np.linalg.norm(part - part[0], axis=1).max()
