"""Cars that are mirror-symmetric to the middle plane, rigid and on a frame that bends; brakes that differ by side."""

import numpy as np
import pytest

from mbs import Pose, compile, simulate
from mbs.vehicle import load
from tests.vehicle.hatchback import WHEELS, car, drive, mirrored

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


STOP = {"brake": ([0.0, 0.4, 1.2], [0.0, 0.3, 0.3]), "throttle": 0.0}


def stop(side):
    return drive(1.2, inputs=STOP, pose=Pose(speed=25.0), parameters={"brakes.side": side})


@pytest.fixture(scope="module")
def to_the_left():
    return stop(0.1)


def test_the_parameter_moves_torque_from_one_side_to_the_other(to_the_left):
    for wheel in WHEELS:
        share = car().brakes.balance if wheel[0] == "F" else 1.0 - car().brakes.balance
        side = 1.1 if wheel[1] == "L" else 0.9
        torque = np.abs(to_the_left[f"wheel_{wheel}.brake_torque"][-1])
        assert torque == pytest.approx(0.3 * side * share * car().brakes.torque, rel=1e-6)


def test_braking_turns_the_car_to_the_stronger_side(to_the_left):
    assert to_the_left["chassis.yaw"][-1] > 1e-3
    mirrored(to_the_left, stop(-0.1), 1e-7)


def test_torques_of_a_port_are_as_they_are_set_and_pressures_are_not():
    sides = {}
    for kind in ("torque", "pressure"):
        model = car().changed({"ports.brakes": kind, "brakes.side": 0.1}).model()
        sides[kind] = [e.real[5] for e in model.elements if e.name.startswith("brake ")]
        assert ("brakes.side" in [p.name for p in model.parameters]) == (kind == "pressure")
    assert sides == {"torque": [1.0] * 4, "pressure": pytest.approx([1.1, 0.9, 1.1, 0.9])}
