"""The hatchback for its tests."""

from __future__ import annotations

from functools import cache

import numpy as np

from mbs import compile, simulate
from mbs.vehicle import load

WHEELS = ("FL", "FR", "RL", "RR")
ODD = (
    "chassis.y",
    "chassis.roll",
    "chassis.yaw",
    "chassis.vy",
    "chassis.ay",
    "chassis.wx",
    "chassis.wz",
    "steering_rack",
)
EVEN = ("chassis.x", "chassis.z", "chassis.pitch", "chassis.vx", "chassis.vz", "chassis.wy", "speed")


@cache
def car():
    return load("hatchback")


@cache
def system():
    return compile(car().model())


def drive(t_end, h=0.005, inputs=None, *, pose=None, parameters=None, every=1, of=None):
    return simulate(
        *(of or system(), t_end, h, inputs, None, parameters),
        every=every,
        pose=pose,
        progress=False,
        estimate_error=False,
    )


def mirrored(first, second, tolerance):
    """Hold two runs against each other as images in the middle plane."""
    for name in ODD:
        np.testing.assert_allclose(first[name], -second[name], atol=tolerance, err_msg=name)
    for name in EVEN:
        np.testing.assert_allclose(first[name], second[name], atol=tolerance, err_msg=name)
    for a, b in (("L", "R"), ("R", "L")):
        for axle in "FR":
            for name in ("travel", "omega"):
                one, other = first[f"wheel_{axle}{a}.{name}"], second[f"wheel_{axle}{b}.{name}"]
                np.testing.assert_allclose(one, other, atol=100.0 * tolerance, err_msg=f"{axle}{a}.{name}")
