"""Sine with dwell of increasing amplitude to both sides, after 49 CFR 571.126 (FMVSS 126) and ISO 19365."""

import math

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.dwell_series import DwellRun, drive_series, filtered_run, series_amplitudes
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steady_map import refuse_implausible, why_not_reached
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.measures.slowly_increasing_steer import G, angle_by_regression

_RATE = math.radians(13.5)  # rad/s, of the ramp
_RAMP_END = 0.5 * G  # m/s2
_MAX_RUNS = 80


def drive(sheet: Sheet) -> None:
    """Drive ramps to both sides, then the series to both sides."""
    car, settings, steering = sheet.car, sheet.settings, SteeringInput.of(sheet.car.facts)
    speed = settings["speed"] / 3.6
    ramps = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        ramps[side] = _drive_ramp(car, speed, sign, steering.largest)
        sheet.runs[f"ramp_{side}"] = ramps[side].thinned()
        sheet.progress(0.1 * len(ramps))
    refuse_implausible(ramps["left"])
    angles = [angle_by_regression(r.steering, r.acceleration) if len(r.time) else math.nan for r in ramps.values()]
    if not math.isfinite(sum(angles)):
        raise HostError(_message_without_angle(list(ramps.values()), settings["speed"]))
    # The regulation rounds the angles of the ramps and their mean to 0.1°.
    a = _round_angle(0.5 * sum(map(_round_angle, angles)))
    amplitudes = series_amplitudes(a, settings["first"], settings["increment"], steering.largest)
    if len(amplitudes) > _MAX_RUNS:
        raise HostError(
            f"A is {math.degrees(a):.1f}°, so the series to {math.degrees(amplitudes[-1]):.0f}° has "
            f"{len(amplitudes)} runs to each side, where {_MAX_RUNS} are the most: raise the setting increment, "
            "or look at the unit of the steering wheel's angle."
        )
    sides: dict[str, list[DwellRun]] = {}
    for side, sign, begin in (("left", 1.0, 0.2), ("right", -1.0, 0.6)):
        sides[side] = drive_series(car, speed, sign, amplitudes, lambda done, b=begin: sheet.progress(b + 0.4 * done))  # type: ignore[misc]
        sheet.runs |= {f"{side}_{math.degrees(r.amplitude):.0f}_deg": r.run.thinned() for r in sides[side]}
    # Only of the largest amplitude, the first one that slow steering does not reach.
    shortfalls = [s for s in (r.run.shortfall(r.amplitude) for side in sides.values() for r in side[-1:]) if s][:1]
    sheet.add("law")
    for side, runs in sides.items():
        if runs and runs[-1].is_lost:
            sheet.add("lost", a=a, amplitudes=amplitudes, side=side, last=runs[-1])
    sheet.notes += shortfalls
    sheet.add("series", a=a, angles=angles, amplitudes=amplitudes, sides=sides, steering=steering, ramps=ramps)


def _round_angle(angle: float) -> float:
    return math.radians(round(math.degrees(angle), 1))


def _drive_ramp(car: TestedCar, speed: float, side: float, largest: float) -> SteeredRun:
    """Drive the slowly increasing steer to one side. Returns the filtered run."""
    largest_angle = min(largest, math.radians(720.0))
    time, angle = np.array([0.0, largest_angle / _RATE]), side * np.array([0.0, largest_angle])
    name = f"slowly increasing steer {'left' if side > 0.0 else 'right'}"
    return filtered_run(steer(car, name, speed, time, angle, Pedals.HOLD_SPEED, _RAMP_END))


def _message_without_angle(ramps: list[SteeredRun], speed: float) -> str:
    for r in ramps:
        if not len(r.time):
            return why_not_reached(r.result, speed / 3.6)
    reached = min(float(np.abs(r.acceleration).max()) for r in ramps) / G
    return (
        f"The car reaches {reached:.2g} g at {speed:g} km/h while the steering wheel turns slowly; the angle A at "
        "0.3 g needs 0.375 g."
    )
