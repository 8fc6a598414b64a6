"""What of a run is judged: what rests or is prescribed judges nothing, and switches nothing off."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PPoly

import mbs
from mbs.results.judged import Judged, judged_in, judged_sensors, sizes_of

RATE, PLACE = Judged("rad/s", always=False), Judged("m", place=True)
T = np.linspace(0.0, 1.0, 101)


@pytest.mark.parametrize("beside", ["", "a resting centre", "a resting centre alone"])
def test_a_body_that_tumbles_beside_a_sensor_at_rest_is_told(beside: str) -> None:
    """About its middle axis, 0.1 s steps: rates are off by their range; the resting centre silenced that."""
    m = mbs.Model("tumbling body", gravity=(0.0, 0.0, 0.0))
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=np.diag([0.1, 0.2, 0.3]))
    m.initial_velocity(body, linear=(0.0, 0.0, 0.0), angular=(0.01, 5.0, 0.01))
    for c in "xyz" if beside else "":
        m.sense_position(f"centre.{c}", body, None, c)
    for c in "xyz" if "alone" not in beside else "":
        m.sense_rotation(f"rate.{c}", body, c, order=1)
    with pytest.warns(mbs.AccuracyWarning, match="coordinate" if "alone" in beside else "rate"):
        run = mbs.simulate(mbs.compile(m), 20.0, 0.05, progress=False)
    assert run.accuracy is not None
    assert set(run.accuracy.units) == {"1" if "alone" in beside else "rad/s"}


def arm(rate: float) -> mbs.System:
    """A driven arm with a rod that swings on it: the angle of the motor, its torque and the rate of the rod."""
    m = mbs.Model("arm", dimension=2)
    first = m.body("first", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    rod = m.body("rod", mass=2.0, com=(1.25, 0.0), inertia=0.05)
    m.revolute("pin", m.ground, first, point=(0.0, 0.0))
    m.revolute("joint", first, rod, point=(1.0, 0.0))
    angle = m.relative_angle("angle", m.ground, first)
    drive = m.drive("drive", angle, m.guide_time("turn", PPoly([[rate], [0.0]], [0.0, 10.0]), unit="rad"))
    m.sense_coordinate("motor.angle", angle)
    m.sense_joint("motor.torque", drive, "drive")
    m.sense_rotation("rod.rate", rod, "z", order=1)
    return mbs.compile(m)


def test_a_prescribed_angle_switches_rates_and_the_torque_of_its_motor_on() -> None:
    system = arm(4.0)
    found = judged_sensors(system)
    assert found["motor.angle"].prescribed
    with pytest.warns(mbs.AccuracyWarning, match="off by"):
        run = mbs.simulate(system, 3.0, 0.05, progress=False)
    assert run.accuracy is not None
    assert set(run.accuracy.sensors) == {"motor.angle", "motor.torque", "rod.rate"}
    fine = mbs.simulate(system, 3.0, 0.0005, every=100, progress=False, estimate_error=False)
    size = np.ptp(fine["rod.rate"])
    assert run.accuracy.sensors["rod.rate"] / size == pytest.approx(
        np.abs(run["rod.rate"] - fine["rod.rate"]).max() / size, rel=0.5
    )


@pytest.mark.parametrize(
    ("place", "rates"),
    [
        pytest.param(PLACE, False, id="a place that moves"),
        pytest.param(Judged("m", place=True, prescribed=True), True, id="one that is prescribed"),
    ],
)
def test_rates_are_judged_where_no_place_moves_by_itself(place: Judged, rates: bool) -> None:
    candidates = {"x": place, "rate": RATE}
    values = {"x": np.sin(T), "rate": np.cos(9.0 * T)}
    assert ("rate" in judged_in(values, candidates, 1.0)) == rates
    assert "rate" in judged_in(values | {"x": 0.0 * T}, candidates, 1.0)
    assert "rate" not in judged_in(values | {"x": 0.0 * T}, candidates, 1.0, stands=True)


def test_errors_are_held_against_the_largest_range_in_the_unit() -> None:
    values = {"large": 1000.0 + 10.0 * np.sin(9.0 * T), "small": 1e-3 * T, "load": 5.0 + T, "rest": 0.0 * T}
    found = sizes_of(values, {"large": PLACE, "small": PLACE, "load": Judged("N", load=True), "rest": RATE}, length=1.0)
    assert found == pytest.approx({"large": 20.0, "small": 20.0, "load": 6.0}, rel=1e-3)
