"""The hatchback for its tests."""

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


def mirrored(first, second, share, of_acceleration=None):
    """Hold two runs against each other as images in the middle plane: to a share of the largest value, or of 1, of
    which wheels may have a hundred; that of accelerations may be another.
    """
    pairs = [(name, name, -1.0, share) for name in ODD] + [(name, name, 1.0, share) for name in EVEN]
    pairs[ODD.index("chassis.ay")] = ("chassis.ay", "chassis.ay", -1.0, of_acceleration or share)
    for a, b in (("FL", "FR"), ("FR", "FL"), ("RL", "RR"), ("RR", "RL")):
        pairs += [(f"wheel_{a}.{name}", f"wheel_{b}.{name}", 1.0, 100.0 * share) for name in ("travel", "omega", "Fz")]
    for name, other, sign, part in pairs:
        size = max(1.0, np.abs(first[name]).max())
        np.testing.assert_allclose(first[name], sign * second[other], rtol=0, atol=part * size, err_msg=name)
