"""Cars that are mirror-symmetric to the middle plane, rigid and on a frame that bends."""

import numpy as np
import pytest

from mbs import Pose, compile, simulate
from mbs.vehicle import load
from tests.vehicle.hatchback import mirrored

TIMES = (0.0, 0.5, 1.5, 3.0, 4.5, 6.0, 10.0)
STEERING = np.array([0.0, 0.0, 0.25, -0.25, 0.15, -0.1, 0.0])
BENT = 1e-5
"""Of accelerations of a frame that vibrates in its joints; those of positions and rates are 1e-7 at every fidelity. The
driver is a mass at joints, what balances him is mass of the modes: together they are their own image to 3e-10, but a
step errs differently by each, and after a kink of the steering stiff modes ring with the difference, 5e-6 of the
acceleration. Without both it is 3e-8."""


def run(system, t_end, speed, **inputs):
    pose = Pose(speed=speed)
    return simulate(system, t_end, 0.005, inputs, pose=pose, progress=False, estimate_error=False)


@pytest.mark.parametrize(("name", "fidelity"), [("hatchback", 0), pytest.param("prototype", 3, marks=pytest.mark.slow)])
def test_left_is_the_image_of_right(name, fidelity):
    """Hands off for 30 s with full throttle, then steered to the left and to the right."""
    system = compile(load(name).model(fidelity=fidelity))
    alone = run(system, 30.0, 30.0, throttle=1.0)
    assert np.abs(alone["chassis.y"]).max() < 1e-4
    left, right = (run(system, 10.0, 15.0, steering=(TIMES, k * STEERING), throttle=0.2) for k in (1, -1))
    assert np.ptp(left["chassis.y"]) > 10.0
    assert np.abs(left["chassis.ay"]).max() > 3.0
    mirrored(left, right, 1e-7, 1e-7 if fidelity == 0 else BENT)
