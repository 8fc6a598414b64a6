"""One period of sinusoidal steering, to both sides, after ISO 7401."""

import math

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steady_map import drive_ramp
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.measures.one_period import SinusoidalResponse, measure_response

_AFTER = 2.0  # s, straight ahead
_POINTS = 400  # of a period


def drive(sheet: Sheet) -> None:
    """Drive a slow ramp, then one period that begins to each side."""
    ramp = drive_ramp(sheet, sheet.settings["lateral_acceleration"])
    sheet.progress(0.4)
    amplitude = ramp.required_angle_at(sheet.settings["lateral_acceleration"])
    period = 1.0 / sheet.settings["frequency"]
    t = np.linspace(0.0, period, _POINTS + 1)
    time, sine = np.append(t, period + _AFTER), np.append(np.sin(2.0 * math.pi * t / period), 0.0)
    sides: dict[str, SteeredRun] = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        sides[side] = steer(sheet.car, f"sine {side}", ramp.speed, time, sign * amplitude * sine, Pedals.FIXED)
        sheet.runs[f"sine_{side}"] = sides[side].thinned()
        sheet.progress(0.4 + 0.3 * len(sides))
    shortfalls = sorted(set(filter(None, [run.shortfall(amplitude) for run in sides.values()])))
    sheet.add("run", amplitude=amplitude, **sides)
    sheet.notes += shortfalls
    for name, signal, units in (
        ("yaw_rate", "yaw_rate", ("1/s", "rad/s")),
        ("lateral_acceleration", "acceleration", ("m/(s2.rad)", "m/s2")),
    ):
        results = {side: {"period": _measure_period(run, getattr(run, signal), period)} for side, run in sides.items()}
        sheet.add("quantity", name=name, word=name.replace("_", " "), units=units, **results)


def _measure_period(run: SteeredRun, values: NDArray[np.float64], period: float) -> SinusoidalResponse:
    """Measure the period and the time after it, of signals minus their means before the steering."""
    if not run.whole:
        return SinusoidalResponse()
    before, during = run.time < 0.0, (run.time >= 0.0) & (run.time <= period + _AFTER)
    steering, response = (x[during] - (x[before].mean() if before.any() else x[0]) for x in (run.steering, values))
    return measure_response(run.time[during], steering, response, max_lag=0.45 * period)
