"""Toe and camber as set: in the drawing, at rest, in the kinematics and on the road."""

import math

import numpy as np
import pytest

from mbs import Pose, Simulation, compile, simulate
from mbs.vehicle import load
from mbs.vehicle.car import Car
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.kinematics import kinematics
from mbs.vehicle.kinematics.held_car import HeldCar
from mbs.vehicle.kinematics.table import number_text, rows

ANGLES = {
    "front.alignment.toe_left": 0.004,
    "front.alignment.toe_right": -0.002,
    "front.alignment.camber_left": -0.015,
    "front.alignment.camber_right": -0.025,
    "rear.alignment.toe_left": 0.003,
    "rear.alignment.toe_right": 0.005,
    "rear.alignment.camber_left": -0.02,
    "rear.alignment.camber_right": 0.01,
}


def _run(car: Car, duration: float, speed: float = 0.0):
    return simulate(compile(car.model()), duration, 0.005, pose=Pose(speed=speed), progress=False, estimate_error=False)


@pytest.fixture(scope="module")
def car():
    return load("hatchback").changed(ANGLES)


def test_kinematics_at_the_drawing_have_the_angles_of_the_file_and_the_table_shows_them(car):
    result = kinematics(car, points=5)
    for axle in ("front", "rear"):
        drawn = result.curves[axle, "parallel"].drawn()
        for angle in ("toe", "camber"):
            for side in ("left", "right"):
                assert drawn[f"{angle}_angle_{side}"] == pytest.approx(
                    ANGLES[f"{axle}.alignment.{angle}_{side}"], abs=1e-12
                )
    shown = {line[0]: line[1:3] for line in rows(result)}
    for angle in ("toe", "camber"):
        requested = [ANGLES[f"{axle}.alignment.{angle}_right"] for axle in ("front", "rear")]
        assert shown[f"{angle} angle, right wheel"] == tuple(number_text(math.degrees(a)) for a in requested)


@pytest.mark.slow
def test_bump_steer_is_that_of_the_linkage_with_straight_wheels(car):
    """The hub turns with its carrier: what is set adds to what the linkage does, to first order."""
    straight, aligned = (kinematics(c, (-0.02, 0.02), 3).drawn("front") for c in (load("hatchback"), car))
    for name in ("toe_gradient", "camber_gradient"):
        assert straight[name] != 0.0
        assert aligned[name] == pytest.approx(straight[name], rel=0.02)


def test_wheels_of_the_standing_car_lean_and_point_as_set(car):
    rest = _run(car, 0.1)
    for wheel, sign in (("FL", 1.0), ("FR", -1.0), ("RL", 1.0), ("RR", -1.0)):
        axle, side = {"F": "front", "R": "rear"}[wheel[0]], {"L": "left", "R": "right"}[wheel[1]]
        toe, camber = (ANGLES[f"{axle}.alignment.{angle}_{side}"] for angle in ("toe", "camber"))
        assert rest[f"wheel_{wheel}.steer"][-1] == pytest.approx(-sign * toe, abs=2e-4)
        assert rest[f"wheel_{wheel}.inclination"][-1] == pytest.approx(-sign * camber, abs=2e-4)
        assert abs(rest[f"wheel_{wheel}.Fy"][-1]) < 25.0


def test_rear_toe_in_pushes_both_wheels_inwards_by_the_slope_of_the_tyre():
    """Straight ahead: F = slope tan(toe), the closed form of the initial slope of TMeasy at the wheel's load."""
    toe = 0.002
    car = load("hatchback").changed({"rear.alignment.toe_left": toe, "rear.alignment.toe_right": toe})
    run = _run(car, 3.0, 15.0)
    first, second = car.rear.tyre.lateral.slope
    for wheel, inwards in (("RL", -1.0), ("RR", 1.0)):
        q = run[f"wheel_{wheel}.Fz"][-1] / car.rear.tyre.nominal_load
        slope = q * (2.0 * first - 0.5 * second - (first - 0.5 * second) * q)
        expected = inwards * slope * math.tan(abs(run[f"wheel_{wheel}.slip_angle"][-1]))
        assert run[f"wheel_{wheel}.slip_angle"][-1] == pytest.approx(-inwards * toe, abs=2e-4)
        assert run[f"wheel_{wheel}.Fy"][-1] == pytest.approx(expected, rel=0.03)
    assert abs(run["chassis.yaw"][-1]) < 1e-3


def test_the_held_car_has_its_contacts_on_the_ground(car):
    for name, wheel in HeldCar(car, Fidelity.RIGID).wheels.items():
        axle, side = {"F": "front", "R": "rear"}[name[0]], {"L": "left", "R": "right"}[name[1]]
        height = getattr(car, axle).wheel.centre[2]
        assert wheel.radius == pytest.approx(height / math.cos(ANGLES[f"{axle}.alignment.camber_{side}"]), rel=1e-12)


@pytest.mark.slow
def test_angles_that_parameters_write_are_those_of_the_car_built_so_by_tables_too():
    """At rest, where the equilibrium is another, and on the road; without them the numbers are those of the file.

    Cars with links are in `test_parameters`.
    """
    car = load("prototype")
    written = compile(car.model(fidelity=Fidelity.TABLE))
    built = compile(car.changed(ANGLES).model(fidelity=Fidelity.TABLE))
    # At rest forces are known to the round-off of positions (decision 3), the start of a drive has another.
    for pose, most in ((None, 1e-8), (Pose(speed=20.0), 2e-6)):
        one, two, old = (
            Simulation(system, parameters=values, pose=pose).run(0.3, 0.005, estimate_error=False)
            for system, values in ((written, ANGLES), (built, {}), (written, {}))
        )
        for signal in one:
            if not signal.startswith("solver."):
                size = max(1.0, float(np.max(np.abs(two[signal]))))
                assert np.max(np.abs(one[signal] - two[signal])) < most * size, signal
        assert np.max(np.abs(one["wheel_RL.axis_x"] - old["wheel_RL.axis_x"])) > 1e-4
        assert pose is None or np.max(np.abs(one["wheel_RL.Fy"] - old["wheel_RL.Fy"])) > 50.0
