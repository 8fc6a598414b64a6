"""Steering on the spot: what bore torque of the tyres asks of the rack."""

import math

import numpy as np
import pytest

from mbs import Simulation, compile, simulate
from mbs.elements import PlaneRoad
from mbs.vehicle import load
from mbs.vehicle.kinematics import kinematics

BORE = {"width": 0.145, "stiffness": 5000.0, "damping": 30.0}
PRESSURE = 2.3e5  # Pa, usual of the class


def _parked(h: float, **changed: object):
    """A second and a half of steering to the left lock and one of rest, with both brakes."""
    car = load("hatchback").changed(changed)
    inputs = {
        "hand_brake": lambda t: 1.0,
        "brake": lambda t: 1.0,
        "steering": lambda t: min(max(t - 0.5, 0.0) / 1.5, 1.0),
    }
    return simulate(compile(car.model()), 3.0, h, inputs, None, progress=False, estimate_error=False)


@pytest.fixture(scope="module")
def parked():
    return _parked(0.005, **{"front.tyre.bore": BORE, "rear.tyre.bore": BORE})


@pytest.mark.slow
def test_a_car_of_1250_kg_asks_for_kilonewtons_at_the_rack(parked):
    """By power the rack carries the moment of both wheels, beside what lifts the car: that is there on ice too."""
    ice = _parked(0.005, **{"front.tyre.grip": 0.0})
    steer = kinematics(load("hatchback"), points=41).curves["front", "steer"]
    rack = float(np.interp(1.9, parked.t, parked["steering_rack"]))
    at = np.argmin(np.abs(steer["rack_travel"] - rack))
    ratios = [float(np.gradient(steer[f"steer_angle_{side}"], steer["rack_travel"])[at]) for side in ("left", "right")]
    moments = [float(np.interp(1.9, parked.t, parked[f"wheel_{wheel}.Mz"])) for wheel in ("FL", "FR")]
    by_power = -np.dot(ratios, moments)
    force, other = (float(np.interp(1.9, run.t, run["steering_rack_force"])) for run in (parked, ice))
    assert 2500.0 < abs(by_power) < 5000.0
    assert abs(force - other) == pytest.approx(abs(by_power), rel=0.1)


def test_the_moment_of_a_wheel_is_that_of_the_formula_of_gough(parked):
    """M = mu/3 sqrt(F^3/p), as R. S. Sharp and R. Granger have it, Proc. IMechE D 217 (2003), 87-96."""
    load_of, moment = (float(np.interp(1.9, parked.t, parked[f"wheel_FL.{name}"])) for name in ("Fz", "Mz"))
    assert abs(moment) == pytest.approx(math.sqrt(load_of**3 / PRESSURE) / 3.0, rel=0.25)


def test_it_takes_energy_and_comes_to_rest(parked):
    assert parked["energy.tyres"][-1] < -100.0
    late = parked.t > 2.6
    assert np.ptp(parked["steering_rack_force"][late]) < 0.01 * np.abs(parked["steering_rack_force"]).max()
    assert np.abs(parked["chassis.wz"][late]).max() < 1e-3
    assert parked["solver.halvings"].max() == 0.0


@pytest.mark.slow
@pytest.mark.parametrize(("name", "pedal"), [("hatchback", "hand_brake"), ("prototype", "brake")])
def test_a_braked_car_stays_on_a_slope_of_a_tenth(name: str, pedal: str) -> None:
    """Within 20 um in a minute, once it has settled; it rolls away without."""
    car = load(name)
    system = compile(car.model(PlaneRoad(grade_x=0.1, friction=car.road.friction)))
    names = [entry["name"] for entry in system.meta["inputs"]]
    neutral = {"selector": 0.0} if "selector" in names else {}
    s = Simulation(system, inputs={pedal: 1.0} | neutral)
    s.step(0.002, 5000)
    before = s.sensors["chassis.x"]
    s.step(0.002, 30000)
    assert abs(s.sensors["chassis.x"] - before) < 2e-5
    s.set_input(pedal, 0.0)
    s.step(0.002, 500)
    assert s.sensors["chassis.x"] < before - 0.3


@pytest.mark.slow
def test_a_pushed_car_without_brakes_rolls_against_its_resistance() -> None:
    """r artanh(F r / (f_r m g R)) in the end, r the loaded radius; with the hand brake it stands."""
    car = load("hatchback").changed({"ports.forces": "earth"})
    s = Simulation(compile(car.model()), inputs={"point_reference.Fx": 5.0, "hand_brake": 1.0, "selector": 0.0})
    s.step(0.002, 2500)
    assert abs(s.sensors["speed"]) < 1e-5
    s.set_input("hand_brake", 0.0)
    s.step(0.002, 15000)
    now, tyre = s.sensors, car.front.tyre
    resistance = tyre.rolling_resistance * sum(now[f"wheel_{w}.Fz"] for w in ("FL", "FR", "RL", "RR"))
    loaded = now["wheel_FL.loaded_radius"]
    assert now["speed"] == pytest.approx(loaded * math.atanh(5.0 / resistance * loaded / tyre.radius), rel=0.02)
