"""What a run with a step of the steering yields, and both sides of it as measures."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

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


def measures_of_step(level: str, wanted: float, left: SteppedRun, right: SteppedRun, angle_unit: str) -> list[Measure]:
    """Measures of the runs to both sides, as means.

    `level`: first part of their names; `wanted`: steady lateral acceleration, m/s²; `angle_unit`: of the steering
    wheel: ``rad``, or ``1`` where angles are not known.
    """
    a = f" at {wanted:g} m/s²"
    no_peak = "The yaw rate does not overshoot: it has no peak response time."

    peaks = not all(s.yaw_rate.overshoot == 0.0 for s in (left, right))

    def made(name: str, value: Callable[[SteppedRun], float], unit: str, text: str, why: str = "") -> Measure:
        exists = peaks or why != no_peak
        return mean_of_sides(f"{level}.{name}", value(left), value(right), unit, text + a, why=why, exists=exists)

    def sign(s: SteppedRun) -> float:
        return math.copysign(1.0, s.angle)

    per = {"rad": ("1/s", "m/(s2.rad)"), "1": ("rad/s", "m/s2")}[angle_unit]
    return [
        made("steering_wheel_angle", lambda s: abs(s.angle), angle_unit, "step of the steering wheel"),
        made(
            "lateral_acceleration.steady",
            lambda s: sign(s) * s.acceleration.steady,
            "m/s2",
            "steady lateral acceleration, as it came out",
        ),
        made("yaw_rate.gain", lambda s: s.yaw_rate.steady / s.angle, per[0], "steady yaw rate over steering angle"),
        made(
            "yaw_rate.response_time",
            lambda s: s.yaw_rate.response_time,
            "s",
            "time from 50 % of steering to 90 % of the yaw rate",
        ),
        made(
            "yaw_rate.peak_response_time",
            lambda s: s.yaw_rate.peak_response_time,
            "s",
            "time from 50 % of steering to the peak of the yaw rate",
            no_peak,
        ),
        made(
            "yaw_rate.overshoot", lambda s: s.yaw_rate.overshoot, "1", "overshoot of the yaw rate over its steady value"
        ),
        made(
            "lateral_acceleration.gain",
            lambda s: s.acceleration.steady / s.angle,
            per[1],
            "steady lateral acceleration over steering angle",
        ),
        made(
            "lateral_acceleration.response_time",
            lambda s: s.acceleration.response_time,
            "s",
            "time from 50 % of steering to 90 % of the lateral acceleration",
        ),
        made(
            "lateral_acceleration.overshoot",
            lambda s: s.acceleration.overshoot,
            "1",
            "overshoot of the lateral acceleration over its steady value",
        ),
        made("sideslip.steady", lambda s: sign(s) * s.sideslip, "rad", "steady sideslip angle, in a turn to the left"),
        made(
            "tb_factor",
            lambda s: s.yaw_rate.peak_response_time * abs(s.sideslip),
            "rad.s",
            "TB: peak response time of the yaw rate times steady sideslip angle",
            no_peak,
        ),
        made(
            "roll.gradient",
            lambda s: s.roll.steady / s.acceleration.steady,
            "rad.s2/m",
            "roll angle over lateral acceleration",
        ),
        made("roll.overshoot", lambda s: s.roll.overshoot, "1", "overshoot of the roll angle over its steady value"),
        asymmetry(
            f"{level}.asymmetry",
            [(left.yaw_rate.steady / left.angle, right.yaw_rate.steady / right.angle)],
            "difference of the yaw rate gain left and right over their mean" + a,
        ),
    ]


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
