"""Sine with dwell of increasing amplitude to both sides, after 49 CFR 571.126 (FMVSS 126) and ISO 19365."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import SPUN
from hosts.catalogue.steady_map import refuse_implausible, why_not_reached
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.measures.filters import phaseless_low_pass
from hosts.measures.sine_with_dwell import G, SineWithDwell, angle_by_regression, measure_sine_with_dwell

_RATE = math.radians(13.5)  # rad/s, of the ramp
_RAMP_END = 0.5 * G  # m/s2
_MAX_RUNS = 80
FREQUENCY = 0.7  # Hz
DWELL = 0.5  # s
AFTER = 2.0  # s, straight ahead
_MIN_LAST_AMPLITUDE = math.radians(270.0)
_MAX_AMPLITUDE = math.radians(300.0)
_MIN_SAMPLES = 20  # of a run that is filtered and measured


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


@dataclass(frozen=True)
class DwellRun:
    """A run of the series: its amplitude, signals and measures."""

    amplitude: float
    """Requested amplitude, rad."""
    run: SteeredRun
    """The run with filtered signals, minus their means before the steering."""
    measures: SineWithDwell

    @property
    def is_lost(self) -> bool:
        """Whether the sideslip exceeded 90°, the car rolled over, or the FMU refused a step."""
        return not self.run.whole or self.measures.sideslip > SPUN


def series_amplitudes(a: float, first: float, increment: float, full_lock: float) -> list[float]:
    """Increasing amplitudes of a series, rad.

    `a`: angle A at 0.3 g, rad; `first`, `increment`: first amplitude and increment, divided by A; `full_lock`: largest
    angle of the steering wheel, rad. The last amplitude is the greater of 6.5 A and 270°, but at most 300° and full
    lock.
    """
    last = min(_MAX_AMPLITUDE if 6.5 * a > _MAX_AMPLITUDE else max(6.5 * a, _MIN_LAST_AMPLITUDE), full_lock)
    multiples = a * (first + increment * np.arange(math.ceil(max(last / a - first, 0.0) / increment)))
    # An amplitude within 1 % of the last one is left out.
    return [float(x) for x in multiples if x < 0.99 * last] + [last]


def sine_with_dwell_table(amplitude: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times, s, and angles of a sine of 0.7 Hz with a dwell of 0.5 s at its second peak, then straight ahead."""
    period = 1.0 / FREQUENCY
    first = np.linspace(0.0, 0.75 * period, 301)
    second = np.linspace(0.75 * period, period, 101)
    time = np.concatenate([first, second + DWELL, [period + DWELL + AFTER]])
    angle = np.concatenate([np.sin(2.0 * math.pi * FREQUENCY * x) for x in (first, second)] + [np.zeros(1)])
    return time, amplitude * angle


def filtered_run(run: SteeredRun) -> SteeredRun:
    """Filter a run with 12 poles without phase (steering wheel 10 Hz, others 6 Hz), and subtract means before it."""
    if len(run.time) < _MIN_SAMPLES:
        return run
    is_before = (run.time < -0.1) if (run.time < -0.1).any() else run.time <= 0.0

    def low_passed(values: NDArray[np.float64], frequency: float) -> NDArray[np.float64]:
        if np.isnan(values).any():
            return values
        filtered = phaseless_low_pass(values, run.interval, min(frequency, 0.4 / run.interval))
        return np.asarray(filtered - filtered[is_before].mean())

    return replace(
        run,
        steering=low_passed(run.steering, 10.0),
        yaw_rate=low_passed(run.yaw_rate, 6.0),
        acceleration=low_passed(run.acceleration, 6.0),
    )


def drive_series(
    car: TestedCar, speed: float, side: float, amplitudes: list[float], progress: Callable[[float], None]
) -> list[DwellRun]:
    """Drive runs with increasing amplitudes until the car is lost.

    `speed`: speed at the beginning of steer, coasting, m/s; `side`: 1: first to the left, -1: first to the right;
    `amplitudes`: amplitudes, rad.
    """
    runs: list[DwellRun] = []
    for k, amplitude in enumerate(amplitudes):
        name = f"{math.degrees(amplitude):.0f} deg {'left' if side > 0.0 else 'right'}"
        run = filtered_run(steer(car, name, speed, *sine_with_dwell_table(side * amplitude), Pedals.COAST))
        progress((k + 1) / len(amplitudes))
        measures = SineWithDwell()
        if len(run.time) >= _MIN_SAMPLES:
            slip = None if np.isnan(run.sideslip).any() else run.sideslip
            measures = measure_sine_with_dwell(run.time, run.steering, run.yaw_rate, run.acceleration, slip)
        runs.append(DwellRun(amplitude, run, measures))
        if runs[-1].is_lost:
            break
    progress(1.0)
    return runs
