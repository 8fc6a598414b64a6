"""A test whose run ended early keeps no limit, and says so."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform
from hosts.catalogue.registry import TESTS, standard_test
from hosts.catalogue.standard.sine_with_dwell import DwellRun, filtered_run, sine_with_dwell_table
from hosts.catalogue.steered_run import Pedals, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.common.wheels import WHEELS
from hosts.driving.result import Result
from hosts.measures.sine_with_dwell import measure_sine_with_dwell
from tests.hosts.catalogue.bicycle import BicycleCar
from tests.hosts.catalogue.measured import sheet_of

FEW = {"double_lane_change": {"course": 2.0, "increment": 20.0, "resolution": 10.0}}
"""Settings that make a test short."""
MOVED_BY_ITSELF = ("drop",)
"""Tests of a car that nobody drives."""


@dataclass(frozen=True)
class Ending(TestedCar):
    """A car whose FMU refuses a step at a time, or that stands with its wheels blocked."""

    at: float = 0.0
    stands: bool = False

    def drive(
        self,
        manoeuvre: Any,
        pilot: Any = None,
        until: Callable[[float, Mapping[str, float]], bool] | None = None,
        record_step: float | None = None,
    ) -> Result:
        """See `TestedCar.drive`."""
        if self.stands:
            start = {n: 0.0 if n == "initial.speed" else x for n, x in manoeuvre.start.items()}
            manoeuvre = replace(manoeuvre, start={**start, "throttle": 0.0, "brake": 1.0}, stop_time=1.0)
            return super().drive(replace(manoeuvre, inputs={}), None, until, record_step)
        short = super().drive(manoeuvre, pilot, lambda t, s: t >= self.at or (until is not None and until(t, s)))
        return replace(short, failed_steps=int(short.time[-1] >= self.at - 1e-9))


@pytest.mark.slow
@pytest.mark.parametrize("name", TESTS)
def test_a_limit_is_not_kept_by_a_run_that_was_not_driven(name: str, prototype: TestedCar) -> None:
    """Each is cut at once, while the speed is reached, and later."""
    cars = [Ending("cut", prototype.fmu, at=at) for at in (0.02, 0.7, 1.6)]
    cars += [] if name in MOVED_BY_ITSELF else [Ending("stands", prototype.fmu, stands=True)]
    for car in cars:
        try:
            record = perform(standard_test(name), car, FEW.get(name, {}))
        except HostError:  # a sentence in place of measures
            continue
        kept = [m.name for m in record.measures if m.is_kept]
        assert not kept, (car.label, car.at, kept)
        missing = [m for m in record.measures if m.is_missing]
        assert missing or record.notes
        assert any(m.note for m in missing) or record.notes


def stop(end: float) -> Result:
    """From 100 km/h with 8 m/s2 from 1 s on, no wheel locked, recorded until `end`, s."""
    time = np.arange(0.0, end + 1e-9, 0.005)
    speed = np.clip(100.0 / 3.6 - 8.0 * np.clip(time - 1.0, 0.0, None), 0.0, None)
    energy = 500.0 * speed**2
    columns = {"speed": speed} | {f"wheel_{w}.slip": 0.0 * time for w in WHEELS}
    columns |= {"energy.total": energy, "energy.kinetic": energy + 1.0, "energy.drive": 0.0 * time}
    columns |= {"energy.brakes": energy - energy[0], "energy.tyres": 0.0 * time}
    return Result(list(columns), {}, time, np.column_stack(list(columns.values())), 1.0, end, 0, [])


@pytest.mark.parametrize(("end", "whole"), [(1.05, False), (2.0, False), (4.4, False), (5.0, True)])
def test_a_stop_keeps_its_limits_once_the_car_stands(end: float, whole: bool) -> None:
    sheet = sheet_of("straight_braking")
    sheet.add("stop", run=stop(end), onset=1.0)
    judged = {m.name: m.is_kept for m in sheet.measures if m.limit is not None}
    assert len(judged) == 7
    assert [kept for name, kept in judged.items() if name != "deceleration.mean_fully_developed"] == 6 * [whole]
    assert all(m.note for m in sheet.measures if m.is_missing)


def test_a_series_that_one_side_has_lost_has_no_displacement() -> None:
    car, speed, a = BicycleCar(), 80.0 / 3.6, 0.2

    def driven(amplitude: float, side: float) -> DwellRun:
        run = filtered_run(steer(car, "m", speed, *sine_with_dwell_table(side * amplitude), Pedals.COAST))
        return DwellRun(amplitude, run, measure_sine_with_dwell(run.time, run.steering, run.yaw_rate, run.acceleration))

    both, one = [[[driven(f * a, s) for f in fs] for s, fs in zip((1.0, -1.0), sides, strict=True)]
                 for sides in (((2.0, 5.0), (2.0, 5.0)), ((2.0, 5.0), (2.0,)))]  # fmt: skip
    kept = []
    for left, right in (both, one):
        sheet = sheet_of("sine_with_dwell")
        results = {"a": a, "angles": [a, a], "sides": {"left": left, "right": right}, "amplitudes": [2.0 * a, 5.0 * a]}
        sheet.add("series", steering=SteeringInput.of(car.facts), ramps={}, **results)
        kept += [m for m in sheet.measures if m.name == "displacement"]
    # of the car that is measured 1 m is enough
    assert [m.value > 1.0 for m in kept] == [True, False]
