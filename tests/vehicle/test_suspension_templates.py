"""MacPherson strut, twist beam and anti-roll bar: kinematics on the rig against the motion at an instant by hand."""

from functools import cache

import pytest

from benchmarks.car.rig import kinematics
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
