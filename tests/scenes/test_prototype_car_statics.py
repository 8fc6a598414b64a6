"""Prototype car at rest against figures found by energy minimisation, without a constraint solver (project data)."""

import numpy as np
import pytest

from mbs import Pose, Simulation, compile, simulate
from mbs.elements import GridRoad
from mbs.scenes import prototype_car
from tests.scenes.car import NEUTRAL, car, car_on_ice, drive

CAR = prototype_car.car()

MASS = 597.0  # kg
WEIGHT = 597.0 * 9.81  # N
STATIC = {  # front, rear: wheel load N, spring length m, spring deflection m, tyre deflection m
    "F": (1267.3, 0.6217, 0.1283, 0.02112),
    "R": (1661.0, 0.7786, 0.1374, 0.02768),
}
TRAVEL = 0.02  # m each way, range over which the kinematics are fitted
MOTION_RATIO = {"F": 0.640, "R": 0.944}  # - d(spring length)/d(wheel travel)
WHEEL_RATE = {"F": 5065.0, "R": 9433.0}  # N/m
CAMBER_GAIN = {"F": 25.3, "R": 19.8}  # deg/m
STEER = {20.0: (9.14, 9.55), 40.0: (18.17, 20.06), 60.0: (27.3, 32.9)}  # rack mm: outer, inner wheel, deg


def test_the_car_stands_on_a_grid_and_drives_over_bumps():
    """A level grid gives the very start of the plane; on an uneven one the car starts as drawn and settles."""
    level = compile(prototype_car.build(GridRoad((-20.0, -20.0), (0.5, 0.5), np.zeros((80, 80)), 0.9)))
    np.testing.assert_array_equal(level.arrays["q0"], car().arrays["q0"])
    bumps = np.random.default_rng(3).normal(0.0, 0.01, (80, 80))
    rough = compile(prototype_car.build(GridRoad((-5.0, -20.0), (0.5, 0.5), bumps, 0.9)))
    t = simulate(rough, 6.0, 0.01, {"throttle": 0.3}, pose=Pose(z=0.05), progress=False)
    assert t.report.halvings == 0
    assert t["chassis.x"][-1] > 20.0
    assert np.ptp(t["chassis.z"][100:]) < 0.1
    assert np.std(t["wheel_FL.Fz"][100:]) > 50.0  # N: it feels the bumps


@pytest.fixture(scope="module")
def at_rest():
    return Simulation(car(), parameters=NEUTRAL).sensors


def test_size_of_the_system():
    assert car().report["degrees_of_freedom"] == 14
    parts = [CAR.chassis.mass]
    parts += [2 * part.mass for axle in (CAR.front, CAR.rear) for _, part in axle.suspension.bodies]
    parts += [2 * CAR.front.wheel.mass, 2 * CAR.rear.wheel.mass]
    assert sum(parts) == pytest.approx(MASS, abs=1e-9)


@pytest.mark.parametrize("axle", ["F", "R"])
@pytest.mark.parametrize("side", ["L", "R"])
def test_wheel_loads_and_deflections(at_rest, axle, side):
    load, length, compression, tyre = STATIC[axle]
    stiffness = (CAR.front if axle == "F" else CAR.rear).spring.stiffness
    w = axle + side
    assert at_rest[f"wheel_{w}.Fz"] == pytest.approx(load, abs=0.1)
    assert at_rest[f"spring_{w}.length"] == pytest.approx(length, abs=1e-4)
    assert -at_rest[f"spring_{w}.force"] == pytest.approx(stiffness * compression, abs=stiffness * 1e-4)
    assert at_rest[f"wheel_{w}.deflection"] == pytest.approx(tyre, abs=1e-5)


def test_wheel_loads_carry_the_weight_and_the_car_stands_as_designed(at_rest):
    assert sum(at_rest[f"wheel_{w}.Fz"] for w in ("FL", "FR", "RL", "RR")) == pytest.approx(WEIGHT, abs=1e-6)
    design = CAR.vehicle.reference_point
    assert at_rest["chassis.x"] == pytest.approx(design[0], abs=1e-5)
    assert at_rest["chassis.z"] - design[2] == pytest.approx(-0.165e-3, abs=2e-6)
    assert np.degrees(at_rest["chassis.pitch"]) == pytest.approx(-0.004, abs=5e-4)
    for name in ("chassis.y", "chassis.roll", "chassis.yaw", "wheel_FL.steer", "wheel_RL.steer"):
        assert abs(at_rest[name]) < 1e-6


@pytest.fixture(scope="module")
def heaving():
    """The car let go 3 cm too high, on ice: the wheels go through their travel, both sides alike."""
    return drive(car_on_ice(), 3.0, 0.002, neutral=True, pose=Pose(z=0.03))


def slope_at_rest(trajectory, w, name):
    travel = trajectory[f"wheel_{w}.travel"]
    near = np.abs(travel) < TRAVEL
    assert np.ptp(travel[near]) > 0.02
    return np.polynomial.Polynomial.fit(travel[near], trajectory[name][near], 4).convert().coef[1]


@pytest.mark.parametrize("axle", ["F", "R"])
def test_motion_ratio_wheel_rate_and_camber_gain(heaving, axle):
    w = f"{axle}L"
    ratio = -slope_at_rest(heaving, w, f"spring_{w}.length")
    stiffness = (CAR.front if axle == "F" else CAR.rear).spring.stiffness
    assert ratio == pytest.approx(MOTION_RATIO[axle], abs=1.5e-3)
    assert stiffness * ratio**2 == pytest.approx(WHEEL_RATE[axle], rel=5e-3)
    camber = np.degrees(slope_at_rest(heaving, w, f"wheel_{w}.camber"))
    assert abs(camber) == pytest.approx(CAMBER_GAIN[axle], rel=0.02)
    assert camber > 0.0  # in bump the top of the left wheel leans in, a turn about x from y to z


@pytest.mark.parametrize(("sign", "rack"), [(1.0, 20.0), (-1.0, 40.0), (1.0, 60.0)])
def test_steering_geometry(sign, rack):
    x = Simulation(car_on_ice(), parameters=NEUTRAL, inputs={"steering": sign * rack / 60.0}).sensors
    assert x["steering_rack"] == pytest.approx(-sign * 1e-3 * rack, abs=1e-12)
    left, right = np.degrees([x["wheel_FL.steer"], x["wheel_FR.steer"]])
    inner, outer = (left, right) if sign > 0 else (right, left)
    assert outer == pytest.approx(sign * STEER[rack][0], abs=0.06)
    assert inner == pytest.approx(sign * STEER[rack][1], abs=0.06)
    assert x["steering_wheel_angle"] == pytest.approx(sign * rack / 42.0 * 2 * np.pi)
