"""Prototype car that should stay where it is: on the level, on slopes, after braking."""

import numpy as np
import pytest

import mbs
from benchmarks.car.manoeuvres import rise
from mbs import Pose, Settings, compile, simulate
from mbs.elements.road import PlaneRoad
from mbs.scenes import prototype_car
from tests.scenes.car import H, car, displacement, drive, positions

STILL = 1e-3  # m
CREEP = 1e-6  # m/s on a slope of ten per cent
SETTLED = 1e-5  # m
GRADE = 0.1


@pytest.mark.parametrize("case", ["brake", "neutral"])
def test_forty_seconds_at_rest(case):
    """With the brake on, the drive's creep torque leans on it: it moves the car by a fraction of a millimetre, once."""
    braked = case == "brake"
    t = drive(car(), 40.0, H, {"brake": 1.0 if braked else 0.0}, neutral=not braked, every=10)
    assert displacement(t, 0.0, 40.0) < (STILL if braked else 1e-9)
    assert displacement(t, 10.0, 40.0) < 1e-6
    energy = t["energy.total"] - t["energy.total"][0]
    work = 2 * 60.0 * 2 * 0.9e-3 / 0.29  # J: creep torque times the give of the brakes
    assert energy.max() < (work if braked else 1e-9)
    assert np.abs(np.diff(energy[-200:])).max() < 1e-9
    assert t["energy.kinetic"][-1] < 1e-12
    assert t.report.halvings == 0
    assert t.report.mean_iterations < 1.1


@pytest.mark.slow
def test_the_braked_car_stands_with_the_energy_momentum_step():
    """Its carried velocity rings; brushes and brakes that took that for a motion let the car creep by metres."""
    settings = Settings(method="energy_momentum")
    t = simulate(car(), 60.0, H, {"brake": 1.0}, settings, every=10, progress=False, estimate_error=False)
    assert displacement(t, 0.0, 60.0) < STILL
    assert displacement(t, 20.0, 60.0) < SETTLED


@pytest.mark.slow
@pytest.mark.parametrize(("way", "grade"), [("grade_x", GRADE), ("grade_y", -GRADE)])
def test_parked_on_a_slope_up_and_across(way, grade):
    """It starts level above the slope, falls onto it and stays; what remains is the creep of the tyres."""
    system = compile(prototype_car.build(PlaneRoad(**{way: grade})))
    t = drive(system, 25.0, H, {"brake": 1.0}, every=10, pose=Pose(z=0.25))
    pull = {"grade_x": "Fx", "grade_y": "Fy"}[way]
    force = sum(t[f"wheel_{w}.{pull}"][-1] for w in ("FL", "FR", "RL", "RR"))
    assert abs(force) == pytest.approx(597.0 * 9.81 * GRADE / np.hypot(1.0, GRADE), rel=0.02)
    assert displacement(t, 15.0, 25.0) < 10.0 * CREEP
    assert t["energy.kinetic"][-1] < 1e-9


@pytest.mark.parametrize(("road", "slope"), [("level", 0.0), ("up", GRADE), ("down", -GRADE)])
def test_braked_from_15_m_s_to_a_stop_that_lasts(road, slope):
    system = car() if road == "level" else compile(prototype_car.build(rise(grade=slope)))
    pedal = ([0.0, 2.5, 2.7, 40.0], [0.0, 0.0, 0.5, 0.5])
    t = drive(system, 20.0, H, {"brake": pedal}, pose=Pose(speed=15.0))
    stop = t.t[np.argmax(t["speed"] < 0.05)]
    assert 4.0 < stop < 5.5
    # mean deceleration between 12 and 4 m/s: half of the brakes' torque, drive, slope
    fast, slow = np.argmax(t["speed"] < 10.0), np.argmax(t["speed"] < 5.0)
    deceleration = (t["speed"][fast] - t["speed"][slow]) / (t.t[slow] - t.t[fast])
    torque = 650.0 / 0.263 + 450.0 / 0.281  # N: both wheels of an axle at half pedal, rolling radii
    assert deceleration == pytest.approx(torque / 597.0 + 9.81 * slope, rel=0.06)
    assert displacement(t, stop + 3.0, stop + 13.0) < 2e-4
    assert displacement(t, stop + 8.0, stop + 13.0) < 1e-5
    assert t["energy.kinetic"][-1] < 1e-6
    assert positions(t)[-1][0] > 40.0


def test_wheels_of_a_car_that_drives_forward_turn_forward():
    """Without slip: 10 m/s over the rolling radius, (2 R + height of the centre) / 3."""
    simulation = mbs.Simulation(mbs.compile(prototype_car.build()), pose=mbs.Pose(speed=10.0))
    car = prototype_car.car()
    for axle, data in (("front", car.front), ("rear", car.rear)):
        radius = (2.0 * data.tyre.radius + data.wheel.centre[2]) / 3.0
        for side in "LR":
            assert simulation.sensors[f"wheel_{axle[0].upper()}{side}.omega"] == pytest.approx(10.0 / radius, rel=1e-3)
