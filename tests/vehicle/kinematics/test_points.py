"""Every template against positions found by SciPy from the hard points alone, over travel and steering."""

from functools import cache

import numpy as np
import pytest

from mbs.vehicle import load
from mbs.vehicle.kinematics.car_kinematics import wheel_by_rack
from mbs.vehicle.kinematics.curves import steer_curve, travel_curve
from mbs.vehicle.linkages.linkage import Linkage
from tests.vehicle import instant
from tests.vehicle.kinematics.point_and_link import Beam, Upright

TRAVEL = np.linspace(-0.08, 0.08, 9)
AXLES = [("prototype", "front"), ("prototype", "rear"), ("hatchback", "front")]


@cache
def linkage(car, axle):
    return Linkage(load(car), axle)


def hold(curve, k, side, centre, axis):
    """A wheel of a curve against centre and axis."""
    assert curve[f"wheel_centre_x_{side}"][k] == pytest.approx(centre[0], abs=1e-10)
    assert curve[f"wheel_centre_y_{side}"][k] == pytest.approx(centre[1], abs=1e-10)
    assert curve[f"steer_angle_{side}"][k] == pytest.approx(np.arctan2(-axis[0], axis[1]), abs=1e-10)
    assert curve[f"inclination_angle_{side}"][k] == pytest.approx(np.arcsin(axis[2]), abs=1e-10)


def outward(order):
    """Numbers from the drawing outwards, so that each start is near its solution."""
    middle = len(order) // 2
    return [*range(middle, len(order))], [*range(middle, -1, -1)]


def hold_axis(curve, k, side, upright, centre):
    """The steering axis through both ball joints, and where it meets the ground."""
    sign = {"left": 1.0, "right": -1.0}[side]
    lower, upper = upright.axis()
    axis = upper - lower
    assert curve[f"caster_angle_{side}"][k] == pytest.approx(np.arctan2(-axis[0], axis[2]), abs=1e-9)
    assert curve[f"kingpin_inclination_angle_{side}"][k] == pytest.approx(
        np.arctan2(-sign * axis[1], axis[2]), abs=1e-9
    )
    contact = np.array([curve[f"contact_centre_{c}_{side}"][k] for c in "xyz"])
    steer = curve[f"steer_angle_{side}"][k]
    for point, ahead, inside in (
        (contact, "caster_trail", "kingpin_offset_at_ground"),
        (centre, "caster_offset_at_wheel_centre", "kingpin_offset_at_wheel_centre"),
    ):
        gap = lower + axis * (point[2] - lower[2]) / axis[2] - point
        assert curve[f"{ahead}_{side}"][k] == pytest.approx(gap[0] * np.cos(steer) + gap[1] * np.sin(steer), abs=1e-9)
        across = gap[1] * np.cos(steer) - gap[0] * np.sin(steer)
        assert curve[f"{inside}_{side}"][k] == pytest.approx(-sign * across, abs=1e-9)


@pytest.mark.parametrize(("car", "axle"), AXLES)
def test_wheel_travel(car, axle):
    link = linkage(car, axle)
    curve = travel_curve(link, "opposite", TRAVEL)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for part in outward(TRAVEL):
            upright = Upright(link.data, sign)
            for k in part:
                centre, axis = upright.at(sign * TRAVEL[k]).wheel()
                hold(curve, k, side, centre, axis)
                hold_axis(curve, k, side, upright, centre)


@pytest.mark.parametrize("car", ["prototype", "hatchback"])
def test_steering(car):
    link = linkage(car, "front")
    steering = link.car.steering
    per_rack = link.car.rack_direction * 2.0 * np.pi / steering.rack_per_turn
    curve = steer_curve(link, np.linspace(-steering.rack_travel, steering.rack_travel, 9), wheel_by_rack(link.car))
    assert np.all(np.diff(curve["steering_wheel_angle"]) > 0.0)
    assert np.all(np.diff(curve["mean_steer_angle"]) > 0.0)  # to the left is positive
    np.testing.assert_allclose(curve["steering_wheel_angle"], per_rack * curve["rack_travel"], rtol=1e-14, atol=1e-15)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for part in outward(TRAVEL):
            upright = Upright(link.data, sign)
            for k in part:
                centre, axis = upright.at(0.0, curve["rack_travel"][k]).wheel()
                hold(curve, k, side, centre, axis)
                hold_axis(curve, k, side, upright, centre)
    ratio = np.gradient(curve["steering_wheel_angle"], curve["mean_steer_angle"])
    np.testing.assert_allclose(curve["steering_ratio"][2:-2], ratio[2:-2], rtol=0.01)


def test_twist_beam():
    link = linkage("hatchback", "rear")
    curve = travel_curve(link, "single", TRAVEL)
    for part in outward(TRAVEL):
        beam = Beam(link.data)
        for k in part:
            beam.at(TRAVEL[k], 0.0)
            for j, side in enumerate(("left", "right")):
                hold(curve, k, side, *beam.wheel(j))
    assert not [name for name in curve.columns if name.startswith(("caster", "kingpin"))]


@pytest.mark.parametrize(
    ("motion", "car", "axle"), [("parallel", "prototype", "front"), ("opposite", "hatchback", "rear")]
)
def test_gradients_are_slopes_of_their_curves(motion, car, axle):
    fine = np.linspace(-0.03, 0.03, 61)
    curve = travel_curve(linkage(car, axle), motion, fine)
    for angle, gradient in (("toe_angle", "toe_gradient"), ("camber_angle", "camber_gradient")):
        slope = np.gradient(curve[f"{angle}_left"], fine, edge_order=2)
        np.testing.assert_allclose(curve[f"{gradient}_left"][1:-1], slope[1:-1], atol=2e-5)
    for length, ratio in (("spring_length", "spring_ratio"), ("damper_length", "damper_ratio")):
        slope = -np.gradient(curve[f"{length}_left"], fine, edge_order=2)
        np.testing.assert_allclose(curve[f"{ratio}_left"][1:-1], slope[1:-1], atol=2e-5)
    slope = np.gradient(curve["spring_load_left"], fine, edge_order=2)
    np.testing.assert_allclose(curve["wheel_rate_left"][1:-1], slope[1:-1], rtol=2e-4)


def test_signs_of_toe_and_camber_are_those_of_their_names():
    """By the twist of the left upright per travel: its z part turns it to the left, its x part to the right."""
    link = linkage("hatchback", "front")
    twist = instant.per_travel(instant.macpherson(link.data.suspension.points), link.data.wheel.centre)
    drawn = travel_curve(link, "parallel", np.array([-0.01, 0.0, 0.01])).drawn()
    for side in ("left", "right"):
        assert drawn[f"toe_gradient_{side}"] == pytest.approx(-twist[5], rel=1e-9)
        assert drawn[f"camber_gradient_{side}"] == pytest.approx(-twist[3], rel=1e-9)
    assert twist[5] > 0.05  # the front of the left wheel goes to the left in bump: it toes out


@pytest.mark.parametrize("axle", ["front", "rear"])
def test_wheels_that_lean_roll_on_their_contacts(axle):
    """The saloon's wheels lean by 0.5 and 1.5 degrees: their contacts lie wider than their centres."""
    link = linkage("saloon", axle)
    curve = travel_curve(link, "opposite", np.array([-1e-4, 0.0, 1e-4]))
    names = "contact_centre_y", "contact_centre_z", "inclination_angle", "spring_load"
    y, z, inclination, load = ([curve[f"{name}_{side}"] for side in ("left", "right")] for name in names)
    lean = 0.5 * (inclination[0] + inclination[1]) - (z[0] - z[1]) / (y[0] - y[1])
    moment = y[0][1] * load[0] + y[1][1] * load[1]
    drawn, roll = curve.drawn(), np.diff(curve["suspension_roll_angle"][::2])
    assert y[0][1] - link.data.wheel.centre[1] > 0.003
    assert np.diff(lean[::2]) / roll == pytest.approx(drawn["roll_camber"], rel=1e-6)
    assert -np.diff(moment[::2]) / roll == pytest.approx(drawn["roll_stiffness"], rel=1e-6)


def test_roll_of_the_twist_beam():
    """Each half turns about the line through its pivot and the middle of the shear axis."""
    link = linkage("hatchback", "rear")
    twist = instant.per_travel(instant.twist_beam(link.data.suspension.points, "roll"), link.data.wheel.centre)
    roll = -0.5 * link.data.track * twist  # per roll angle, left side up: the left wheel goes down by half the track
    drawn = travel_curve(link, "opposite", np.array([-0.01, 0.0, 0.01])).drawn()
    assert drawn["roll_steer"] == pytest.approx(roll[5], rel=1e-9)
    assert drawn["roll_camber"] == pytest.approx(1.0 + roll[3], rel=1e-9)
    velocity = instant.velocity(roll, instant.contact(link.data.wheel.centre))
    assert drawn["roll_centre_height"] == pytest.approx(0.5 * link.data.track * velocity[1] / velocity[2], rel=1e-9)
    lever = instant.lever_rate(link.data.anti_roll_bar, twist)
    assert drawn["anti_roll_bar_ratio"] == pytest.approx(lever, rel=1e-9)  # both levers turn, per both travels
    bar, beam = link.data.anti_roll_bar.stiffness * lever**2, link.data.suspension.torsional_stiffness * twist[4] ** 2
    assert 2.0 * (bar + beam) < drawn["wheel_rate_left"] < 2.0 * (bar + beam) + link.data.spring.stiffness


def test_no_bar_no_part_of_the_bar():
    """The bar's share of the wheel rate in roll is its stiffness times twice the square of its ratio."""
    car = load("hatchback")
    bare = Linkage(car.changed({"front.anti_roll_bar.factor": 0.0}), "front")
    travel = np.array([-0.01, 0.0, 0.01])
    with_bar, without = (
        travel_curve(link, "opposite", travel).drawn() for link in (linkage("hatchback", "front"), bare)
    )
    share = 2.0 * car.front.anti_roll_bar.stiffness * with_bar["anti_roll_bar_ratio"] ** 2
    assert with_bar["wheel_rate_left"] - without["wheel_rate_left"] == pytest.approx(share, rel=1e-6)


@pytest.mark.parametrize(("car", "axle"), [("prototype", "front"), ("hatchback", "rear")])
def test_tangent_and_bending_of_the_way(car, axle):
    """Against differences of positions, along a direction of both wheels and the rack."""
    link, step = linkage(car, axle), 1e-4
    direction = np.array([1.0, 0.5, 0.7 if link.has_rod else 0.0])
    at = link.solve(link.drawn.q, np.array([0.03, -0.02]), 0.01 if link.has_rod else 0.0)
    ahead, behind = (
        link.solve(at.q, at.travel + s * direction[:2], at.rack + s * direction[2]).q for s in (step, -step)
    )  # fmt: skip
    np.testing.assert_allclose(at.tangent @ direction, (ahead - behind) / (2.0 * step), atol=1e-5)
    bend = link.second_derivatives(at, direction[:, None])[:, 0]
    np.testing.assert_allclose(bend, (ahead - 2.0 * at.q + behind) / step**2, atol=2e-3)
    assert np.abs(bend).max() > 1.0


def test_wheelbase_of_trailing_arms_and_of_a_strut():
    """In parallel travel the arms turn about their pivots: a wheel that comes up beyond their height comes forwards."""
    link = linkage("hatchback", "rear")
    x, _, z = np.subtract(link.data.wheel.centre, link.data.suspension.points.pivot)
    back = np.sqrt(x**2 + z**2 - (z + TRAVEL) ** 2) + x  # of the centres against the drawing
    np.testing.assert_allclose(travel_curve(link, "parallel", TRAVEL)["wheelbase_change"], back, atol=1e-12)
    front = travel_curve(linkage("hatchback", "front"), "parallel", TRAVEL)
    np.testing.assert_allclose(front["wheelbase_change"], front["contact_centre_x_left"], atol=1e-12)
