"""What a run with a step of the steering yields, and both sides of it as measures."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from hosts.catalogue.record import MeasureText
from hosts.catalogue.steered_run import SteeredRun
from hosts.catalogue.two_sides import asymmetry, mean_of_sides
from hosts.measures.measure import Measure
from hosts.measures.step_response import NOTHING, StepResponse, mean_between, reference_time, step_response

_BEFORE = (-0.8, 0.0)
_SLOWEST = 0.15
_UNSTEADY = 0.05


@dataclass(frozen=True)
class SteppedRun:
    """What one run yields; NaN where it does not."""

    run: SteeredRun
    angle: float
    """Step of the steering wheel, rad."""
    rise: float
    """Time from 10 to 90 % of it, s."""
    yaw_rate: StepResponse
    acceleration: StepResponse
    roll: StepResponse
    sideslip: float
    """Of the steady state, rad."""


def stepped(run: SteeredRun, steady: tuple[float, float]) -> SteppedRun:
    """Evaluate a run.

    `steady`: beginning and end of the window of the steady state, s after the beginning of the steering.
    """
    t = run.time
    if not len(t) or t[-1] < steady[1] - 1e-6:
        return SteppedRun(run, math.nan, math.nan, NOTHING, NOTHING, NOTHING, math.nan)
    first = mean_between(t, run.steering, *_BEFORE)[0]
    angle = mean_between(t, run.steering, *steady)[0] - first
    reference = reference_time(t, run.steering, _BEFORE, steady)
    if angle == 0.0 or not math.isfinite(reference):
        return SteppedRun(run, math.nan, math.nan, NOTHING, NOTHING, NOTHING, math.nan)
    part = (run.steering - first) / angle
    rise = float(t[np.argmax(part >= 0.9)] - t[np.argmax(part >= 0.1)])
    slip = mean_between(t, run.sideslip, *steady)[0] - mean_between(t, run.sideslip, *_BEFORE)[0]
    yaw_rate, acceleration, roll = (
        step_response(t, x, reference, _BEFORE, steady) for x in (run.yaw_rate, run.acceleration, run.roll)
    )
    return SteppedRun(run, angle, rise, yaw_rate, acceleration, roll, slip)


VALUES: Mapping[str, Callable[[SteppedRun], float]] = {
    "steering_wheel_angle": lambda s: abs(s.angle),
    "lateral_acceleration.steady": lambda s: _sign(s) * s.acceleration.steady,
    "yaw_rate.gain": lambda s: s.yaw_rate.steady / s.angle,
    "yaw_rate.response_time": lambda s: s.yaw_rate.response_time,
    "yaw_rate.peak_response_time": lambda s: s.yaw_rate.peak_response_time,
    "yaw_rate.overshoot": lambda s: s.yaw_rate.overshoot,
    "lateral_acceleration.gain": lambda s: s.acceleration.steady / s.angle,
    "lateral_acceleration.response_time": lambda s: s.acceleration.response_time,
    "lateral_acceleration.overshoot": lambda s: s.acceleration.overshoot,
    "sideslip.steady": lambda s: _sign(s) * s.sideslip,
    "tb_factor": lambda s: s.yaw_rate.peak_response_time * abs(s.sideslip),
    "roll.gradient": lambda s: s.roll.steady / s.acceleration.steady,
    "roll.overshoot": lambda s: s.roll.overshoot,
}
"""What `step_steer.toml` describes, of one side."""
_OF_PEAK = ("yaw_rate.peak_response_time", "tb_factor")
_OF_INPUT = {"steering_wheel_angle": "1", "yaw_rate.gain": "rad/s", "lateral_acceleration.gain": "m/s2"}
"""Units where the steering is no angle."""


def _sign(s: SteppedRun) -> float:
    return math.copysign(1.0, s.angle)


def measures_of_step(
    about: Mapping[str, MeasureText], level: str, wanted: float, left: SteppedRun, right: SteppedRun, is_angle: bool
) -> list[Measure]:
    """Measures of the runs to both sides, as means.

    `about`: what they are; `level`: first part of their names; `wanted`: steady lateral acceleration, m/s²; `is_angle`:
    whether angles of the steering wheel are known.
    """
    peaks = not all(s.yaw_rate.overshoot == 0.0 for s in (left, right))
    at = f" at {wanted:g} m/s²"
    made = []
    for name, value in VALUES.items():
        unit = about[name].unit if is_angle else _OF_INPUT.get(name, about[name].unit)
        why = "The yaw rate does not overshoot: it has no peak response time." if name in _OF_PEAK else ""
        exists = peaks or name not in _OF_PEAK
        sides = value(left), value(right)
        made.append(mean_of_sides(f"{level}.{name}", *sides, unit, about[name].text + at, why, exists))
    gains = VALUES["yaw_rate.gain"](left), VALUES["yaw_rate.gain"](right)
    words = f"difference of the yaw rate gain left and right over their mean{at}"
    return [*made, asymmetry(f"{level}.asymmetry", [gains], words)]


def remarks(wanted: float, left: SteppedRun, right: SteppedRun) -> list[str]:
    """Sentences on what was not as the standard wants it."""
    said = []
    rise = max(left.rise, right.rise)
    if rise > _SLOWEST:
        said.append(
            f"At {wanted:g} m/s² the steering wheel takes {rise:.3g} s from 10 to 90 %; ISO 7401 allows {_SLOWEST:g} s "
            "(by summaries): raise steering_rate, or the car's own steering is slower."
        )
    restless = max(s.yaw_rate.unsteadiness for s in (left, right))
    if restless > _UNSTEADY:
        said.append(
            f"At {wanted:g} m/s² the yaw rate varies by {restless:.2g} of its value in the window of the steady state; "
            "a later window (steady_from, steady_to) may be steadier."
        )
    for side, run in (("left", left), ("right", right)):
        if not math.isfinite(run.angle):
            said.append(f"At {wanted:g} m/s² the run to the {side} ended before the steady state.")
    return said
