"""Sine with dwell of growing amplitude, to both sides, after 49 CFR 571.126 (FMVSS 126) and ISO 19365."""

import math

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.dwell_series import DwellRun, amplitudes, processed, series
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steady_map import refuse_odd, why_not_reached
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.measures.slowly_increasing_steer import G, angle_by_regression

_RATE = math.radians(13.5)
_RAMP_TO = 0.5 * G
_MOST_RUNS = 80


def drive(sheet: Sheet) -> None:
    """Ramps to both sides, then the series to both sides."""
    car, settings, steering = sheet.car, sheet.settings, SteeringInput.of(sheet.car.facts)
    speed = settings["speed"] / 3.6
    ramps = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        ramps[side] = _ramp(car, speed, sign, steering.largest)
        sheet.runs[f"ramp_{side}"] = ramps[side].thinned()
        sheet.progress(0.1 * len(ramps))
    refuse_odd(ramps["left"])
    angles = [angle_by_regression(r.steering, r.acceleration) if len(r.time) else math.nan for r in ramps.values()]
    if not math.isfinite(sum(angles)):
        raise HostError(_no_angle(list(ramps.values()), settings["speed"]))
    # the regulation rounds to 0.1°, each ramp and the mean
    a = _rounded(0.5 * sum(map(_rounded, angles)))
    angles_of_series = amplitudes(a, settings["first"], settings["increment"], steering.largest)
    if len(angles_of_series) > _MOST_RUNS:
        raise HostError(
            f"A is {math.degrees(a):.1f}°, so the series to {math.degrees(angles_of_series[-1]):.0f}° has "
            f"{len(angles_of_series)} runs to each side, where {_MOST_RUNS} are the most: raise the setting increment, "
            "or look at the unit of the steering wheel's angle."
        )
    sides: dict[str, list[DwellRun]] = {}
    for side, sign, begin in (("left", 1.0, 0.2), ("right", -1.0, 0.6)):
        sides[side] = series(car, speed, sign, angles_of_series, lambda done, b=begin: sheet.progress(b + 0.4 * done))  # type: ignore[misc]
        sheet.runs |= {f"{side}_{math.degrees(r.amplitude):.0f}_deg": r.run.thinned() for r in sides[side]}
    # one is enough: the largest amplitude is the first that a slow steering does not reach
    slow = [s for s in (r.run.shortfall(r.amplitude) for side in sides.values() for r in side[-1:]) if s][:1]
    sheet.add("law")
    for side, runs in sides.items():
        if runs and runs[-1].is_lost:
            sheet.add("lost", a=a, wanted=angles_of_series, side=side, last=runs[-1])
    sheet.notes += slow
    sheet.add("series", a=a, found=angles, wanted=angles_of_series, sides=sides, given=steering, ramps=ramps)


def _rounded(angle: float) -> float:
    return math.radians(round(math.degrees(angle), 1))


def _ramp(car: TestedCar, speed: float, side: float, largest: float) -> SteeredRun:
    """The slowly increasing steer to one side, filtered."""
    end = min(largest, math.radians(720.0))
    time, angle = np.array([0.0, end / _RATE]), side * np.array([0.0, end])
    name = f"slowly increasing steer {'left' if side > 0.0 else 'right'}"
    return processed(steer(car, name, speed, time, angle, Pedals.HOLD_SPEED, _RAMP_TO))


def _no_angle(ramps: list[SteeredRun], speed: float) -> str:
    for r in ramps:
        if not len(r.time):
            return why_not_reached(r.result, speed / 3.6)
    reached = min(float(np.abs(r.acceleration).max()) for r in ramps) / G
    return (
        f"The car reaches {reached:.2g} g at {speed:g} km/h while the steering wheel turns slowly; the angle A at "
        "0.3 g needs 0.375 g."
    )
