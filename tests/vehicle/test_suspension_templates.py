"""MacPherson strut, twist beam and anti-roll bar: kinematics on the rig against the motion at an instant by hand."""

from functools import cache

import numpy as np
import pytest

from benchmarks.car.rig import kinematics
from mbs import compile
from mbs.compiler.overconstrained import corrected_joints
from mbs.vehicle import CarFileError, car_names, load
from tests.vehicle import instant


@cache
def hatchback():
    return load("hatchback")


@cache
def measured():
    return kinematics(hatchback())


def rolls(axle, twist):
    """Twist of the left side per suspension roll angle: the left wheel goes down by half the track."""
    return -0.5 * axle.track * instant.per_travel(twist, axle.wheel.centre)


def stiffer_by(axle, rate, more):
    """Gain of roll stiffness by a stiffer torsion spring that its sides turn by `rate` each per roll angle.

    The axle rolls on its tyres besides, and its load acts on the side of the roll centre: hence the denominator.
    """
    load = 2.0 * axle.tyre.stiffness * (axle.tyre.radius - axle.wheel.centre[2])
    on_tyres = 0.5 * axle.tyre.stiffness * axle.track**2
    name = "front" if axle is hatchback().front else "rear"
    return more * (2.0 * rate) ** 2 / (1.0 - load * measured()[f"{name}.roll_centre_height"] / on_tyres)


def test_the_loops_of_a_car_move_as_drawn():
    """So a car that only stands is compiled without the search for overconstrained loops."""
    results = {name: corrected_joints(load(name).model()) for name in car_names()}
    assert len(results) > 5
    assert not any(results.values()), results


def test_macpherson_in_bump():
    axle = hatchback().front
    twist = instant.per_travel(instant.macpherson(axle.suspension.points), axle.wheel.centre)
    strut = np.subtract(axle.suspension.points.strut_top, axle.suspension.points.strut_lower)
    along = instant.velocity(twist, np.array(axle.suspension.points.strut_lower)) @ strut / np.linalg.norm(strut)
    assert measured()["front.spring_ratio"] == pytest.approx(along, rel=2e-3)
    assert measured()["front.bump_steer"] == pytest.approx(twist[5], rel=0.01)
    assert measured()["front.bump_camber"] == pytest.approx(-twist[3], rel=0.01)
    assert twist[5] > 0.05  # it toes out


def test_macpherson_in_roll():
    axle = hatchback().front
    twist = rolls(axle, instant.macpherson(axle.suspension.points))
    velocity = instant.velocity(twist, instant.contact(axle.wheel.centre))
    height = 0.5 * axle.track * velocity[1] / velocity[2]
    assert measured()["front.roll_centre_height"] == pytest.approx(height, rel=0.02)
    assert 0.02 < height < 0.12
    assert measured()["front.roll_steer"] == pytest.approx(twist[5], rel=0.02)
    assert measured()["front.roll_camber"] == pytest.approx(1.0 + twist[3], rel=0.02)


def test_the_steering_axis_is_that_of_the_class():
    p, centre = hatchback().front.suspension.points, hatchback().front.wheel.centre
    axis = np.subtract(p.strut_top, p.lower_ball_joint)
    assert 10.0 < np.degrees(np.arctan2(-axis[1], axis[2])) < 16.0  # inclination of the kingpin
    assert 2.0 < np.degrees(np.arctan2(-axis[0], axis[2])) < 6.0  # caster
    ground = np.array(p.lower_ball_joint) - axis * p.lower_ball_joint[2] / axis[2]
    assert abs(centre[1] - ground[1]) < 0.02  # scrub radius
    assert 0.01 < ground[0] - centre[0] < 0.04  # caster trail
    inner, outer = measured()["lock_inner"], measured()["lock_outer"]
    assert 0.0 < inner - outer < 0.2  # between parallel and Ackermann's
    # a turn to the left by the same angle as to the right, with the sides exchanged
    assert measured()["steering_ratio"] > 0.0


def test_twist_beam_in_bump_moves_straight_up():
    axle = hatchback().rear
    twist = instant.per_travel(instant.twist_beam(axle.suspension.points, "bump"), axle.wheel.centre)
    lower, upper = (np.array(getattr(axle.suspension.points, f"spring_{end}")) for end in ("lower", "upper"))
    along = (upper - lower) / np.linalg.norm(upper - lower)
    assert measured()["rear.spring_ratio"] == pytest.approx(instant.velocity(twist, lower) @ along, rel=2e-3)
    assert abs(measured()["rear.bump_steer"]) < 1e-6
    assert abs(measured()["rear.bump_camber"]) < 1e-6


def test_twist_beam_in_roll_turns_about_the_line_through_its_pivot_and_the_shear_centre():
    axle = hatchback().rear
    twist = rolls(axle, instant.twist_beam(axle.suspension.points, "roll"))
    velocity = instant.velocity(twist, instant.contact(axle.wheel.centre))
    height = 0.5 * axle.track * velocity[1] / velocity[2]
    assert measured()["rear.roll_centre_height"] == pytest.approx(height, rel=2e-3)
    assert 0.08 < height < 0.25
    assert measured()["rear.roll_steer"] == pytest.approx(twist[5], rel=2e-3)
    assert 0.02 < twist[5] < 0.12  # into the turn: it understeers
    assert measured()["rear.roll_camber"] == pytest.approx(1.0 + twist[3], rel=2e-3)


@pytest.mark.slow
def test_a_shear_axis_through_the_pivots_makes_trailing_arms():
    """Then nothing steers or leans against the chassis, and the roll centre is on the road."""
    points = hatchback().rear.suspension.points
    x, _, z = points.pivot
    arms = kinematics(hatchback().changed({"rear.suspension.points.cross_beam": [x, 0.45, z]}))
    for name in ("roll_centre_height", "roll_steer"):
        assert abs(arms[f"rear.{name}"]) < 1e-3
    assert arms["rear.roll_camber"] == pytest.approx(1.0, abs=2e-3)


@pytest.mark.slow
def test_a_shear_axis_through_the_wheels_makes_a_rigid_axle():
    """Then the wheels stand upright on the road in roll; the roll centre is where the lines to the pivots meet."""
    car = hatchback()
    pivot, centre = car.rear.suspension.points.pivot, car.rear.wheel.centre
    rigid = kinematics(car.changed({"rear.suspension.points.cross_beam": [centre[0], 0.45, centre[2]]}))
    assert abs(rigid["rear.roll_camber"]) < 5e-3
    assert rigid["rear.roll_centre_height"] == pytest.approx(centre[2], abs=3e-3)
    assert rigid["rear.roll_steer"] == pytest.approx((pivot[2] - centre[2]) / (centre[0] - pivot[0]), abs=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("part", ["suspension.torsional_stiffness", "anti_roll_bar.stiffness"])
def test_torsion_stiffens_the_rear_axle_by_the_square_of_its_twist(part):
    axle, more = hatchback().rear, 400.0
    twist = rolls(axle, instant.twist_beam(axle.suspension.points, "roll"))
    rate = twist[4] if part.startswith("suspension") else instant.lever_rate(axle.anti_roll_bar, twist)
    table, name = part.split(".")
    stiffer = kinematics(hatchback().changed({f"rear.{part}": getattr(getattr(axle, table), name) + more}))
    gain = stiffer["rear.roll_stiffness"] - measured()["rear.roll_stiffness"]
    assert gain == pytest.approx(stiffer_by(axle, rate, more), rel=1e-3)
    assert stiffer["rear.wheel_rate"] == pytest.approx(measured()["rear.wheel_rate"], rel=1e-6)


@pytest.mark.slow
def test_the_front_bar_stiffens_roll_by_the_square_of_its_twist_and_leaves_bump_alone():
    car, more = hatchback(), 200.0
    twist = rolls(car.front, instant.macpherson(car.front.suspension.points))
    rate = instant.lever_rate(car.front.anti_roll_bar, twist)
    stiffer = kinematics(car.changed({"front.anti_roll_bar.stiffness": car.front.anti_roll_bar.stiffness + more}))
    gain = stiffer["front.roll_stiffness"] - measured()["front.roll_stiffness"]
    assert gain == pytest.approx(stiffer_by(car.front, rate, more), rel=3e-3)
    assert stiffer["front.wheel_rate"] == pytest.approx(measured()["front.wheel_rate"], rel=1e-6)


@pytest.mark.slow
def test_without_its_bar_an_axle_rolls_on_its_springs_alone():
    """The factor 0 is a bar that is not there."""
    car = hatchback()
    none = kinematics(car.changed({"front.anti_roll_bar.factor": 0.0, "rear.anti_roll_bar.factor": 0.0}))
    for name, axle, twist in (
        ("front", car.front, rolls(car.front, instant.macpherson(car.front.suspension.points))),
        ("rear", car.rear, rolls(car.rear, instant.twist_beam(car.rear.suspension.points, "roll"))),
    ):
        bar = axle.anti_roll_bar
        lost = stiffer_by(axle, instant.lever_rate(bar, twist), bar.stiffness)
        assert measured()[f"{name}.roll_stiffness"] - none[f"{name}.roll_stiffness"] == pytest.approx(lost, rel=0.01)


def test_two_freedoms_an_axle_and_the_spins():
    report = compile(hatchback().model()).report
    assert report["degrees_of_freedom"] == 14


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"front.anti_roll_bar.part": "wishbone"}, r"front.anti_roll_bar.part is 'wishbone'; .* lower_arm, upright"),
        ({"front.anti_roll_bar.points.lever_end": [-0.26, 0.5, 0.25]}, "lever_end lies 0 m from the axis of the bar"),
        ({"rear.anti_roll_bar.points.link_end": [-2.6, 0.5, 0.36]}, "link_end is where the drop link cannot turn"),
        ({"rear.anti_roll_bar.points.link_end": [-2.43, 0.5, 0.361]}, "link_end is where the drop link cannot turn"),
        ({"rear.anti_roll_bar.points.pivot": [-2.25, -0.35, 0.36]}, "points.pivot has y = -0.35 m"),
        ({"rear.suspension.points.cross_beam": [-2.3, 0.0, 0.3]}, "cross_beam has y = 0 m"),
        ({"rear.suspension.torsional_stiffness": 1.3}, "torsional_stiffness is 1.3; it must be between"),
        ({"front.suspension.points.strut_top": [-0.04, 0.545, 830.0]}, r"strut_top.2 \(z\) is 830"),
    ],
)
def test_a_file_that_cannot_be_is_refused_with_a_sentence(changes, sentence):
    with pytest.raises(CarFileError, match=sentence):
        hatchback().changed(changes)


def test_a_twist_beam_does_not_steer():
    car = hatchback()
    with pytest.raises(CarFileError, match=r"front.suspension.kind is 'twist_beam'; such an axle cannot steer"):
        car.changed({"front.suspension": ahead(car._data["rear"]["suspension"]), "front.anti_roll_bar.part": "half"})


def ahead(suspension):
    """The rear suspension moved to the front axle."""
    points = {name: [p[0] + 2.55, *p[1:]] for name, p in suspension["points"].items()}
    half = suspension["bodies"]["half"]
    bodies = {"half": half | {"com": [half["com"][0] + 2.55, *half["com"][1:]]}}
    return suspension | {"points": points, "bodies": bodies}
