"""Prototype car in motion: cornering, energy, symmetry, invariance."""

import numpy as np
import pytest

from benchmarks.car import manoeuvres
from mbs import Pose, Simulation
from mbs.scenes import prototype_car
from mbs.vehicle.environment import GRAVITY
from tests.elements import tmeasy
from tests.scenes.car import WHEELS, H, car, drive, positions

CAR = prototype_car.car()
FRICTION, AIR = CAR.road.friction, CAR.aerodynamics
TYRES = {"front": CAR.front.tyre.tyre(), "rear": CAR.rear.tyre.tyre()}

MASS = 597.0  # kg
WHEELBASE = 2.3  # m
LOAD = {"front": 1267.3, "rear": 1661.0}  # N
DEFLECTION = {"front": 0.02112, "rear": 0.02768}  # m
TO_FRONT = 1.3046  # m, from the centre of mass


def bicycle(speed, angle, slips):
    """Yaw rate of the linear bicycle model with the tyres' slopes and trails at the static loads.

    At small lateral acceleration the load transfer is of second order and the curves are straight; but in TMeasy the
    initial slope depends on the direction of the slip, so the slips sx, sy of each axle are needed.
    """
    stiffness, trail = {}, {}
    for axle in LOAD:
        q = LOAD[axle] / 1500.0
        sx, sy = (1e-3 * s for s in slips[axle])
        stiffness[axle] = 2.0 * tmeasy.forces(TYRES[axle], LOAD[axle], FRICTION, sx, sy)[1] / sy
        t = TYRES[axle].trail
        trail[axle] = (t[0] + (t[1] - t[0]) * (q - 1.0)) * 2.0 * np.sqrt(TYRES[axle].radius * DEFLECTION[axle])
    a, b = TO_FRONT - trail["front"], WHEELBASE - TO_FRONT + trail["rear"]
    gradient = MASS * (b / stiffness["front"] - a / stiffness["rear"]) / (a + b)
    return speed * angle / (a + b + gradient * speed**2), gradient


@pytest.mark.parametrize(("speed", "steering"), [(8.0, 0.01), (20.0, -0.01)])
def test_steady_cornering_is_that_of_the_bicycle_model(speed, steering):
    t = drive(car(), 6.0, H, {"steering": steering}, neutral=True, pose=Pose(speed=speed))
    v, yaw_rate = t["speed"][-1], t["chassis.wz"][-1]
    angle = 0.5 * (t["wheel_FL.steer"][-1] + t["wheel_FR.steer"][-1])
    slips = {
        axle: [
            np.mean([t[f"wheel_{axle[0].upper()}{side}.{name}"][-1] for side in "LR"])
            for name in ("slip", "slip_angle")
        ]
        for axle in LOAD
    }
    expected, gradient = bicycle(v, angle, slips)
    assert abs(v * yaw_rate) < 1.0
    assert np.sign(yaw_rate) == np.sign(steering)
    assert yaw_rate == pytest.approx(expected, rel=0.01)
    measured = (v * angle / yaw_rate - WHEELBASE) / v**2
    assert measured == pytest.approx(gradient, abs=0.0003)  # rad/(m/s2): 0.17 deg/g


@pytest.mark.parametrize(("speed", "gear"), [(0.0, 1), (6.0, 1), (22.0, 3)])
def test_a_start_finds_the_gear_that_fits(speed, gear):
    assert Simulation(car(), pose=Pose(speed=speed)).sensors["gear"] == gear


def test_full_lock_at_15_m_s():
    """The front slides: the car turns at what its tyres hold, upright, and not at what the wheels point to."""
    t = manoeuvres.run("full_lock", H)
    assert t.report.failures == 0
    assert t.report.halvings == 0
    assert 6.0 < np.abs(t["chassis.ay"]).max() < 11.0
    assert np.abs(t["chassis.roll"]).max() < np.radians(12.0)
    assert np.unwrap(t["chassis.yaw"])[-1] > 3.0
    assert 3.0 < t["speed"][-1] < 7.0
    for w in WHEELS:
        assert np.abs(t[f"wheel_{w}.travel"]).max() < 0.15
        grip = 1.07 * FRICTION  # a little more than the largest force per load
        force = np.hypot(t[f"wheel_{w}.Fx"], t[f"wheel_{w}.Fy"])
        assert np.all(force <= grip * np.maximum(t[f"wheel_{w}.Fz"], 1.0))


@pytest.mark.parametrize(("friction", "pedal"), [(0.9, 1.0), (0.9, 0.3), (0.1, 0.3)])
def test_friction_of_the_road_bounds_the_deceleration(friction, pedal):
    """By the road at most friction times g, 3.5 % more for loads below the nominal one; drag and pitch come on top."""
    t = drive(
        car(), 1.5, 0.002, {"brake": pedal}, neutral=True, pose=Pose(speed=15.0), parameters={"road.friction": friction}
    )
    force, load = (sum(t[f"wheel_{w}.{name}"] for w in WHEELS) for name in ("Fx", "Fz"))
    used = -(force / load)[t["speed"] > 1.0]
    assert used.max() < 1.035 * friction
    if pedal == 1.0 or friction < 0.5:
        assert used.max() > 0.7 * friction
    drag = 0.5 * AIR.air_density * AIR.drag_area * t["speed"] ** 2 / MASS
    slowing = (t["speed"][0] - t["speed"][-1]) / t.t[-1]
    assert slowing < 1.035 * friction * GRAVITY + drag.max()


def test_inclination_counts_from_the_road_and_camber_from_the_vehicle():
    t = drive(car(), 3.0, H, {"steering": 0.15}, neutral=True, pose=Pose(speed=14.0))
    roll = t["chassis.roll"][-1]
    assert abs(roll) > 0.01
    for w in WHEELS:
        inclination, camber = t[f"wheel_{w}.inclination"], t[f"wheel_{w}.camber"]
        assert inclination[0] == pytest.approx(camber[0], abs=5e-4)  # level
        assert inclination[-1] == pytest.approx(camber[-1] + roll, abs=0.03 * abs(roll) + 2e-4)
        sensor = next(s for s in car().meta["sensors"] if s["name"] == f"wheel_{w}.camber")
        assert "deprecated" in sensor["description"]
        assert "inclination" in sensor["description"]


def test_start_turned_and_shifted_gives_the_turned_and_shifted_path():
    inputs = {"steering": ([0.0, 0.5, 1.0, 4.0], [0.0, 0.0, 0.2, 0.2]), "throttle": 0.2}
    yaw, shift = 2.1, np.array([120.0, -45.0])
    plain = drive(car(), 4.0, H, inputs, pose=Pose(speed=10.0))
    turned = drive(car(), 4.0, H, inputs, pose=Pose(shift[0], shift[1], 0.0, yaw, 10.0))
    rotation = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    expected = positions(plain)[:, :2] @ rotation.T + shift
    np.testing.assert_allclose(positions(turned)[:, :2], expected, rtol=0, atol=1e-6)
    heading = np.unwrap(turned["chassis.yaw"]) - np.unwrap(plain["chassis.yaw"])
    np.testing.assert_allclose(np.exp(1j * heading), np.exp(1j * yaw), rtol=0, atol=1e-6)
    for name in ("wheel_FL.Fz", "wheel_RR.Fy", "chassis.ay", "speed"):
        np.testing.assert_allclose(turned[name], plain[name], rtol=0, atol=1e-6 * np.abs(plain[name]).max())
