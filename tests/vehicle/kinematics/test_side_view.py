"""Anti-dive and its like, by the pole in the side view and by the upright's twist, without the engine."""

import numpy as np
import pytest

from mbs.vehicle import load
from mbs.vehicle.kinematics.axle_measures import travel_measures
from mbs.vehicle.linkages.continuation import HEAVE
from mbs.vehicle.linkages.linkage import Linkage
from tests.vehicle import instant
from tests.vehicle.kinematics.planar_wishbones import FourBar

PIVOTS = {
    "lower_pivot_front": (0.15, 0.30, 0.150),
    "lower_pivot_rear": (-0.15, 0.30, 0.170),
    "upper_pivot_front": (0.13, 0.30, 0.390),
    "upper_pivot_rear": (-0.13, 0.30, 0.365),
}
BALLS = FourBar((0.30, 0.16), (0.60, 0.15), (0.30, 0.38), (0.60, 0.385))


def measures(car, axle):
    linkage = Linkage(car, axle)
    return travel_measures(linkage, linkage.drawn, HEAVE)


def lever(car):
    return car.wheelbase / car.vehicle.reference_point[2]


def in_plane(points, x, y):
    """Height of the plane through three points."""
    normal = np.cross(np.subtract(points[1], points[0]), np.subtract(points[2], points[0]))
    return points[0][2] - (normal[0] * (x - points[0][0]) + normal[1] * (y - points[0][1])) / normal[2]


def test_anti_dive_by_the_pole_of_the_side_view():
    """The upright turns about the line in which the planes of both wishbones meet; a tie rod in one of them agrees.

    Where that line meets the plane of the wheel is the pole of the side view; anti-dive is the slope from the contact
    to it (here the pole is behind the wheel and above the ground), times wheelbase over height and the front's share.
    """
    lower = [PIVOTS["lower_pivot_front"], PIVOTS["lower_pivot_rear"], (0.0, 0.60, 0.15)]
    upper = [PIVOTS["upper_pivot_front"], PIVOTS["upper_pivot_rear"], (0.0, 0.60, 0.385)]
    rod = {end: (-0.125, y, float(in_plane(lower, -0.125, y))) for end, y in (("inner", 0.30), ("outer", 0.60))}
    car = BALLS.car(**PIVOTS, **{f"tie_rod_{end}": point for end, point in rod.items()})
    y = car.front.wheel.centre[1]
    low, high = ([in_plane(arm, x, y) for x in (0.0, -1.0)] for arm in (lower, upper))
    behind = (high[0] - low[0]) / ((low[1] - low[0]) - (high[1] - high[0]))
    pole = np.array([-behind, low[0] + behind * (low[1] - low[0])])
    assert pole[0] < -1.0
    assert pole[1] > 0.1
    slope = pole[1] / -pole[0]
    torque = car.brakes.balance / car.front.wheel.centre[2]
    share = torque / (torque + (1.0 - car.brakes.balance) / car.rear.wheel.centre[2])
    found = measures(car, "front")
    assert found["anti_dive"] == pytest.approx(100.0 * share * slope * lever(car), rel=1e-9)
    assert 1.0 < found["anti_dive"] < 100.0
    assert "anti_lift_in_drive" not in found  # the rear wheels drive


def test_anti_dive_and_anti_lift_of_a_macpherson_strut():
    car = load("hatchback")
    centre = car.front.wheel.centre
    twist = instant.per_travel(instant.macpherson(car.front.suspension.points), centre)
    found = measures(car, "front")
    velocity = instant.velocity(twist, instant.contact(centre))
    torque = car.brakes.balance / centre[2]
    share = torque / (torque + (1.0 - car.brakes.balance) / car.rear.wheel.centre[2])
    assert found["anti_dive"] == pytest.approx(100.0 * share * velocity[0] / velocity[2] * lever(car), rel=1e-9)
    middle = instant.velocity(twist, np.array(centre))
    assert found["anti_lift_in_drive"] == pytest.approx(100.0 * middle[0] / middle[2] * lever(car), rel=1e-9)


def test_anti_lift_of_trailing_arms():
    """In parallel travel the twist beam turns about its pivots: behind them the contact goes back as it rises."""
    car = load("hatchback")
    pivot, centre = car.rear.suspension.points.pivot, car.rear.wheel.centre
    slope = pivot[2] / (pivot[0] - centre[0])
    torque = car.brakes.balance / car.front.wheel.centre[2]
    share = 1.0 - torque / (torque + (1.0 - car.brakes.balance) / centre[2])
    found = measures(car, "rear")
    assert found["anti_lift"] == pytest.approx(100.0 * share * slope * lever(car), rel=1e-9)
    assert "anti_squat" not in found


def test_anti_squat_by_the_way_of_the_wheel_centre():
    """Pivots that rise to the front carry the wheel back as it rises: the drive then lifts the car."""
    points = "rear.suspension.points.lower_pivot"
    plain = load("prototype")
    car = plain.changed(
        {f"{points}_front": [-2.12, 0.30, 0.23], f"{points}_rear": [-2.38, 0.30, 0.17], "chassis.frame.or_rigid": True}
    )
    p = dict(car.rear.suspension.points)
    as_strut = p | {"strut_lower": p["lower_ball_joint"]}
    as_strut |= {f"tie_rod_{end}": p[f"toe_link_{end}"] for end in ("inner", "outer")}
    centre = car.rear.wheel.centre
    twist = instant.per_travel(instant.macpherson(as_strut.items()), centre)
    middle, contact = (instant.velocity(twist, np.array(c)) for c in (centre, instant.contact(centre)))
    found = measures(car, "rear")
    assert found["anti_squat"] == pytest.approx(-100.0 * middle[0] / middle[2] * lever(car), rel=1e-9)
    assert found["anti_squat"] > 5.0
    torque = car.brakes.balance / car.front.wheel.centre[2]
    share = 1.0 - torque / (torque + (1.0 - car.brakes.balance) / centre[2])
    assert found["anti_lift"] == pytest.approx(-100.0 * share * contact[0] / contact[2] * lever(car), rel=1e-9)
    assert abs(measures(plain, "rear")["anti_squat"]) < 0.5
