"""Planar wishbones against closed forms: equal and parallel, sloping, unequal; over large travel, and steered."""

from functools import cache

import numpy as np
import pytest

from mbs.vehicle.kinematics.car_kinematics import wheel_by_rack
from mbs.vehicle.kinematics.curves import steer_curve, travel_curve
from mbs.vehicle.linkages.linkage import Linkage
from tests.vehicle.kinematics.planar_wishbones import CENTRE, TRACK_HALF, FourBar

LEVEL = FourBar((0.30, 0.15), (0.60, 0.15), (0.30, 0.385), (0.60, 0.385))
SLOPING = FourBar((0.30, 0.19), (0.60, 0.15), (0.30, 0.425), (0.60, 0.385))
UNEQUAL = FourBar((0.30, 0.165), (0.60, 0.15), (0.35, 0.372), (0.575, 0.385))
TRAVEL = np.linspace(-0.12, 0.12, 13)


@cache
def parallel(linkage):
    return travel_curve(Linkage(linkage.car(), "front"), "parallel", TRAVEL)


def test_level_equal_arms_have_their_roll_centre_on_the_ground():
    assert parallel(LEVEL).drawn()["roll_centre_height"] == pytest.approx(0.0, abs=1e-14)
    assert parallel(SLOPING).drawn()["roll_centre_height"] == pytest.approx(TRACK_HALF * 0.04 / 0.30, rel=1e-12)


def test_unequal_arms_are_the_four_bar_linkage():
    curve = parallel(UNEQUAL)
    wheels = [UNEQUAL.wheel(z) for z in TRAVEL]
    turns = np.array([turn for _, turn, _ in wheels])
    assert np.ptp(turns) > np.radians(5.0)
    np.testing.assert_allclose(curve["inclination_angle_left"], turns, atol=1e-12)
    np.testing.assert_allclose(curve["camber_angle_right"], -turns, atol=1e-12)
    np.testing.assert_allclose(curve["wheel_centre_y_left"], [c[0] for c, _, _ in wheels], atol=1e-12)
    np.testing.assert_allclose(curve["contact_centre_y_left"], [p[0] for _, _, p in wheels], atol=1e-12)
    np.testing.assert_allclose(curve["contact_centre_z_left"], [p[1] for _, _, p in wheels], atol=1e-12)
    np.testing.assert_allclose(curve["track_change"], [2.0 * (p[0] - TRACK_HALF) for _, _, p in wheels], atol=1e-12)
    # d(turn)/d(travel) is 1 over the lever of the pole, camber the opposite of it on the left side
    poles = np.array([UNEQUAL.pole(z) for z in TRAVEL])
    centres = np.array([c for c, _, _ in wheels])
    np.testing.assert_allclose(curve["camber_gradient_left"], -1.0 / (centres - poles)[:, 0], rtol=1e-9)


def test_the_roll_centre_is_on_the_line_from_contact_to_pole():
    curve = parallel(UNEQUAL)
    for k, z in enumerate(TRAVEL):
        (y, ground), (pole_y, pole_z) = UNEQUAL.wheel(z)[2], UNEQUAL.pole(z)
        height = (pole_z - ground) * y / (y - pole_y)
        assert curve["roll_centre_height"][k] == pytest.approx(height, rel=1e-9)


def test_motion_ratio_of_an_inclined_spring():
    """On level arms the wheel centre rises as the ball joint does; the spring takes its part along its own line."""
    curve = parallel(LEVEL).drawn()
    lower, upper = np.array([0.0, 0.50, 0.175]), np.array([0.0, 0.38, 0.785])
    lever = lower[1:] - LEVEL.lower_pivot
    direction = np.array([-lever[1], lever[0]]) / 0.30  # of the spring's end per wheel travel
    line = (upper - lower)[1:] / np.linalg.norm(upper - lower)
    assert curve["spring_ratio_left"] == pytest.approx(direction @ line, rel=1e-12)
    assert curve["damper_ratio_left"] == pytest.approx(direction @ line, rel=1e-12)


def test_wheel_rate_by_the_lever_law_over_large_travel():
    """The wheel does not lean, so the load is that of the spring on its lever, and the rate its derivative."""
    linkage = Linkage(LEVEL.car(), "front")
    spring = linkage.data.spring
    lever, upper = np.subtract((0.50, 0.175), LEVEL.lower_pivot), np.array([0.38, 0.785])

    def load(z):
        turn = np.arcsin(z / 0.30)
        c, s = np.cos(turn), np.sin(turn)
        end = np.array(LEVEL.lower_pivot) + np.array([[c, -s], [s, c]]) @ lever
        across = np.array([-s * lever[0] - c * lever[1], c * lever[0] - s * lever[1]]) / (0.30 * c)
        gap = upper - end
        length = np.linalg.norm(gap)
        return spring.stiffness * (spring.free_length - length) * (across @ gap) / length

    z = np.linspace(-0.06, 0.06, 7)
    curve = travel_curve(linkage, "parallel", z)
    np.testing.assert_allclose(curve["spring_load_left"], [load(x) for x in z], rtol=1e-10)
    slope = [(load(x + 1e-5) - load(x - 1e-5)) / 2e-5 for x in z]
    np.testing.assert_allclose(curve["wheel_rate_left"], slope, rtol=1e-6)
    tyre = linkage.data.tyre.stiffness
    np.testing.assert_allclose(1.0 / curve["ride_rate_left"], 1.0 / np.array(slope) + 1.0 / tyre, rtol=1e-6)
    opposite = travel_curve(linkage, "opposite", z)
    roll = 2.0 * TRACK_HALF**2 * opposite.drawn()["wheel_rate_left"]
    assert opposite.drawn()["roll_stiffness"] == pytest.approx(roll, rel=1e-9)
    assert linkage.data.wheel.centre[2] == CENTRE


def test_ackermann_and_turning_circle_of_upright_steering_axes():
    car = LEVEL.car(tie_rod_inner=(-0.14, 0.30, 0.15), tie_rod_outer=(-0.12, 0.57, 0.15))
    assert car.rack_direction == -1.0  # rods behind the axle
    c = steer_curve(Linkage(car, "front"), np.linspace(-0.05, 0.05, 11), wheel_by_rack(car))
    assert (np.diff(c["steering_wheel_angle"]) > 0.0).all()
    kingpin_y = 0.60
    offset, base = TRACK_HALF - kingpin_y, car.wheelbase
    for k in (0, 2, 8, 10):
        left, right = c["steer_angle_left"][k], c["steer_angle_right"][k]
        inner, outer = (left, right) if left > 0.0 else (-right, -left)  # a turn to the left, mirrored if need be
        # contact centres: the offset turned about the kingpins
        x_in, y_in = -offset * np.sin(inner), kingpin_y + offset * np.cos(inner)
        x_out, y_out = offset * np.sin(outer), -kingpin_y - offset * np.cos(outer)
        middle_in = y_in + (x_in + base) / np.tan(inner)
        ideal = np.arctan2(x_out + base, middle_in - y_out)
        assert c["ackermann_error"][k] == pytest.approx(outer - ideal, abs=1e-12)
        assert c["ackermann"][k] == pytest.approx(100.0 * (inner - outer) / (inner - ideal), rel=1e-9)
        middle = 0.5 * (middle_in + y_out + (x_out + base) / np.tan(outer))
        assert c["turning_circle"][k] == pytest.approx(2.0 * np.hypot(x_out + base, middle - y_out), rel=1e-9)
        assert abs(c["ackermann_steer_angle"][k]) == pytest.approx(ideal, rel=1e-12)
    assert np.isnan(c["ackermann"][5])
    np.testing.assert_allclose(c["ackermann"][:5], c["ackermann"][:5:-1], rtol=1e-9)
