"""A planar steering with upright steering axes: Ackermann and turning circle by hand."""

import numpy as np
import pytest

from mbs.vehicle.kinematics.car_kinematics import wheel_by_rack
from mbs.vehicle.kinematics.curves import steer_curve
from mbs.vehicle.linkages.linkage import Linkage
from tests.vehicle.kinematics.planar_wishbones import TRACK_HALF, FourBar

KINGPIN = np.array([0.0, 0.60])
INNER, OUTER = np.array([-0.14, 0.30]), np.array([-0.12, 0.57])
LINKS = FourBar((0.30, 0.15), (0.60, 0.15), (0.30, 0.385), (0.60, 0.385))
RACK = np.linspace(-0.05, 0.05, 11)


@pytest.fixture(scope="module")
def curve():
    car = LINKS.car(tie_rod_inner=(*INNER, 0.15), tie_rod_outer=(*OUTER, 0.15))
    assert car.rack_direction == -1.0  # rods behind the axle
    return car, steer_curve(Linkage(car, "front"), RACK, wheel_by_rack(car))


def test_ackermann_and_turning_circle(curve):
    car, c = curve
    offset, base = TRACK_HALF - KINGPIN[1], car.wheelbase
    for k in (0, 2, 8, 10):
        left, right = c["steer_angle_left"][k], c["steer_angle_right"][k]
        inner, outer = (left, right) if left > 0.0 else (-right, -left)  # a turn to the left, mirrored if need be
        # contact centres: the offset turned about the kingpins
        x_in, y_in = -offset * np.sin(inner), KINGPIN[1] + offset * np.cos(inner)
        x_out, y_out = offset * np.sin(outer), -KINGPIN[1] - offset * np.cos(outer)
        middle_in = y_in + (x_in + base) / np.tan(inner)
        ideal = np.arctan2(x_out + base, middle_in - y_out)
        assert c["ackermann_error"][k] == pytest.approx(outer - ideal, abs=1e-12)
        assert c["ackermann"][k] == pytest.approx(100.0 * (inner - outer) / (inner - ideal), rel=1e-9)
        middle = 0.5 * (middle_in + y_out + (x_out + base) / np.tan(outer))
        assert c["turning_circle"][k] == pytest.approx(2.0 * np.hypot(x_out + base, middle - y_out), rel=1e-9)
        assert abs(c["ackermann_steer_angle"][k]) == pytest.approx(ideal, rel=1e-12)
    assert np.isnan(c["ackermann"][5])
    np.testing.assert_allclose(c["ackermann"][:5], c["ackermann"][:5:-1], rtol=1e-9)
