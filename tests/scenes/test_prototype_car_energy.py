"""The balance of the car's energy in a drive: what works on it against what it has, and each work against its power."""

import csv
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from mbs.scenes import prototype_car
from mbs.simulation.state import Pose
from tests.scenes.car import WHEELS, car, drive

CAR = prototype_car.car()
AIR, TYRES = CAR.aerodynamics, {"front": CAR.front.tyre.tyre(), "rear": CAR.rear.tyre.tyre()}

WORKS = ("drive", "brakes", "tyres", "dampers", "drag", "ground")
MANOEUVRES = Path(__file__).parents[2] / "hosts" / "driving" / "manoeuvres"


@cache
def launch_and_brake(h):
    with (MANOEUVRES / "launch_and_brake.csv").open(encoding="utf-8", newline="") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    times = [row["time"] for row in rows]
    inputs = {n: (times, [row[n] for row in rows]) for n in ("steering", "throttle", "brake")}
    return drive(car(), times[-1], h, inputs)


def change(t):
    return t["energy.total"] - t["energy.total"][0]


def works(t):
    return {name: t[f"energy.{name}"] for name in WORKS}


def turned_over(t):
    return max(float(np.abs(w).max()) for w in works(t).values())


def test_the_balance_of_a_drive_closes():
    t = launch_and_brake(0.002)
    assert turned_over(t) > 2e5  # J
    open_ = change(t) - sum(works(t).values())
    assert np.abs(open_).max() < 1e-8 * turned_over(t)
    assert abs(open_[-1] - t.report.energy_error) < 1e-8 * turned_over(t)
    for name in ("drive", "brakes", "tyres", "dampers", "drag"):  # each counts
        assert np.abs(open_ - 2.0 * t[f"energy.{name}"]).max() > 100.0 * np.abs(open_).max()


@pytest.mark.slow
def test_the_works_converge_by_second_order():
    runs = [launch_and_brake(h) for h in (0.004, 0.002, 0.001)]
    for name in ("drive", "brakes", "tyres", "drag"):
        ends = [r[f"energy.{name}"][-1] for r in runs]
        assert (ends[0] - ends[1]) / (ends[1] - ends[2]) == pytest.approx(4.0, rel=0.25)


def test_works_are_those_of_the_powers_that_sensors_tell():
    """Of tyres those of slip and of rolling resistance; what carcasses take is left out."""
    t = launch_and_brake(0.002)
    omega, rolling, slip = {w: t[f"wheel_{w}.omega"] for w in WHEELS}, 0.0, 0.0
    for w in WHEELS:
        radius = TYRES["front" if w[0] == "F" else "rear"].radius
        rolling = rolling + 0.015 * t[f"wheel_{w}.Fz"] * radius * omega[w] * np.tanh(omega[w])
        faster = np.maximum(np.abs(omega[w]) * radius, np.abs(t["chassis.vx"]))
        slip = slip + np.abs(t[f"wheel_{w}.Fx"] * t[f"wheel_{w}.slip"]) * faster
    powers = {
        "tyres": -rolling - slip,
        "drive": t["drive_torque"] * (omega["RL"] + omega["RR"] - 2.0 * t["chassis.wy"]),
        "brakes": sum(t[f"wheel_{w}.brake_torque"] * (omega[w] - t["chassis.wy"]) for w in WHEELS),
        "drag": -0.5 * AIR.air_density * AIR.drag_area * t["speed"] ** 3,
    }
    for name, power in powers.items():
        work = np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(t.t))
        assert t[f"energy.{name}"][-1] == pytest.approx(work, rel=0.02 if name == "tyres" else 2e-3)


def test_steering_works_too():
    """The rack is a guide: what it gives is what the elements and the error of the steps leave."""
    t = drive(car(), 3.0, 0.002, {"steering": ([0.0, 0.5, 0.7, 3.0], [0.0, 0.0, 0.3, 0.3])}, pose=Pose(speed=15.0))
    rest = change(t) - sum(works(t).values())
    assert np.abs(rest[t.t < 0.49]).max() < 1e-4
    assert 1.0 < np.abs(rest[-1]) < 500.0
    assert rest[-1] == pytest.approx(rest[t.t > 1.5][0], abs=0.01 * abs(rest[-1]))  # the rack stands
