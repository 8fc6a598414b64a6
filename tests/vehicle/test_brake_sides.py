"""Brakes that differ from left to right, `brakes.side`."""

import numpy as np
import pytest

from mbs import Pose
from tests.vehicle.hatchback import WHEELS, car, drive, mirrored

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
