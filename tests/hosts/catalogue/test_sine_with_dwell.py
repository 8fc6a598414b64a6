"""Sine with dwell of a car that is a linear bicycle model: series, limits, and where it stops."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard.sine_with_dwell import filtered_run, series_amplitudes, sine_with_dwell_table
from hosts.catalogue.steered_run import Pedals, steer
from hosts.common.errors import HostError
from hosts.measures.sine_with_dwell import G
from tests.hosts.catalogue.bicycle import BicycleCar, bicycle, gains

SPEED = 80.0 / 3.6
FEW = {"increment": 3.5}
"""A short series: 1.5 A, 5 A, 8.5 A and the last."""


def degrees(*values: float) -> list[float]:
    return [math.degrees(v) for v in values]


@pytest.mark.parametrize(
    ("a", "lock", "first", "last", "number"),
    [
        (30.0, 500.0, 45.0, 270.0, 16),  # 6.5 A is 195: on to 270
        (44.0, 500.0, 66.0, 286.0, 11),  # 6.5 A is the last
        (50.0, 500.0, 75.0, 300.0, 10),  # 6.5 A is 325: 300
        (30.0, 200.0, 45.0, 200.0, 12),  # full lock
    ],
)
def test_amplitudes_of_a_series(a: float, lock: float, first: float, last: float, number: int) -> None:
    result = degrees(*series_amplitudes(math.radians(a), 1.5, 0.5, math.radians(lock)))
    assert result[0] == pytest.approx(first)
    assert result[-1] == pytest.approx(last)
    assert len(result) == number
    assert np.diff(result)[:-1] == pytest.approx(0.5 * a)


def test_table_is_a_sine_with_a_dwell_at_its_second_peak() -> None:
    time, angle = sine_with_dwell_table(2.0)
    t = np.array([0.0, 0.25 / 0.7, 0.5 / 0.7, 0.75 / 0.7, 0.75 / 0.7 + 0.25, 0.75 / 0.7 + 0.5, 1.0 / 0.7 + 0.5])
    assert np.interp(t, time, angle) == pytest.approx([0.0, 2.0, 0.0, -2.0, -2.0, -2.0, 0.0], abs=1e-3)


def test_a_linear_car_keeps_the_limits() -> None:
    recorded: list[float] = []
    record = perform(standard_test("sine_with_dwell"), BicycleCar(), FEW, recorded.append)
    assert recorded == sorted(recorded)
    assert len(recorded) > 6
    actual = {m.name: m for m in record.measures}
    gain = gains(SPEED)[1]
    a = actual["angle_at_0_3_g"].value
    # the ramp of 13.5 °/s is late: the angle is above that of the steady state
    assert 0.3 * G / gain < a < 0.3 * G / gain + math.radians(13.5) * 0.3
    t = np.arange(0.0, 6.0, 1e-3)
    runs = sorted(name for name in record.runs if name.startswith("left"))
    assert len(runs) == 4
    time, angle = sine_with_dwell_table(5.0 * a)
    # the model stays at the speed from which it coasts
    _, acceleration, slip = lsim(bicycle(SPEED + 0.7), np.interp(t, time, angle), t)[1].T
    begin = math.asin(math.radians(5.0) / (5.0 * a)) / (2 * math.pi * 0.7)
    moved = np.cumsum(np.cumsum(np.where(t > begin, acceleration, 0.0))) * 1e-6
    assert actual["displacement"].value == pytest.approx(float(np.interp(begin + 1.07, t, moved)), rel=0.01)
    assert actual["yaw_rate_ratio_1_00"].value < 0.01
    assert [actual[n].is_kept for n in ("yaw_rate_ratio_1_00", "yaw_rate_ratio_1_75", "displacement")] == [True] * 3
    assert degrees(actual["stable_amplitude.left"].value, actual["stable_amplitude.right"].value) == pytest.approx(
        [270.0] * 2
    )
    # the largest sideslip angle is that of the last run, to which the answer is in proportion
    largest = np.abs(slip[t < 4.2]).max() * math.radians(270.0) / (5.0 * a)
    assert actual["sideslip"].value == pytest.approx(largest, rel=0.01)


@pytest.mark.slow
def test_tyres_that_slide_move_the_car_too_little() -> None:
    record = perform(standard_test("sine_with_dwell"), BicycleCar(strongest=4.0), FEW)
    results = {m.name: m for m in record.measures}
    assert results["displacement"].value < 1.83
    assert results["displacement"].is_kept is False
    heavy = perform(standard_test("sine_with_dwell"), BicycleCar(strongest=4.0), {**FEW, "gross_mass": 3600.0})
    assert next(m.limit for m in heavy.measures if m.name == "displacement").lowest == 1.52  # type: ignore[union-attr]


def test_a_car_that_spins_is_not_driven_further() -> None:
    # above 100° the yaw rate stays after the steering, and the sideslip angle is large
    class Spins(BicycleCar):
        def drive(self, manoeuvre, pilot=None, until=None, record_step=None):  # type: ignore[no-untyped-def]
            result = super().drive(manoeuvre, pilot, until, record_step)
            if "deg" in manoeuvre.name and float(manoeuvre.name.split()[0]) > 100.0:
                slip = result.names.index("sideslip")
                result.values[:, slip] *= 100.0
                result.values[-400:, result.names.index("chassis.wz")] = -5.0 if "left" in manoeuvre.name else 5.0
            return result

    record = perform(standard_test("sine_with_dwell"), Spins(), FEW)
    results = {m.name: m for m in record.measures}
    assert results["yaw_rate_ratio_1_00"].value > 0.35
    assert results["yaw_rate_ratio_1_00"].is_kept is False
    assert results["stable_amplitude.left"].value < math.radians(100.0)
    assert len([name for name in record.runs if name.startswith("right")]) == 2
    assert any("the car is lost at" in n for n in record.notes)
    assert any("without it" in n for n in record.notes)


def test_a_car_that_cannot_reach_the_acceleration_is_refused() -> None:
    with pytest.raises(HostError, match=r"reaches 0\.31 g at 80 km/h"):
        perform(standard_test("sine_with_dwell"), BicycleCar(strongest=3.0), FEW)


def test_a_car_that_takes_no_angle_is_refused() -> None:
    with pytest.raises(HostError, match=r"demands angles.*steering_wheel_angle_max"):
        perform(standard_test("sine_with_dwell"), BicycleCar(steered_by="steering"), FEW)


def test_a_series_without_end_is_refused() -> None:
    with pytest.raises(HostError, match=r"A is 2\d\.\d°.* has 9\d runs to each side, where 80 are the most"):
        perform(standard_test("sine_with_dwell"), BicycleCar(), {"increment": 0.1})


def test_signals_are_filtered_at_their_frequencies_and_zero_before_the_steering() -> None:
    run = steer(BicycleCar(), "sine", SPEED, *sine_with_dwell_table(0.5), Pedals.COAST)
    six, ten = (np.sin(2 * np.pi * f * run.time) for f in (6.0, 10.0))
    result = filtered_run(replace(run, steering=0.3 + ten, yaw_rate=0.3 + six, acceleration=0.3 + six))
    inner = (run.time > 0.5) & (run.time < 3.0)
    for got, wave in ((result.steering, ten), (result.yaw_rate, six), (result.acceleration, six)):
        # half of the amplitude at the cut-off; the mean before the steering, of no whole number of periods, is gone
        assert got[inner] == pytest.approx(0.5 * wave[inner], abs=0.04)
        assert got[run.time < -0.1].mean() == pytest.approx(0.0, abs=1e-12)
