"""Response of a quantity to a step of the steering: times, overshoot and steady value of ISO 7401."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.measures.filters import crossing, interpolated_peak


@dataclass(frozen=True)
class StepResponse:
    """Measures of one quantity; NaN if the record does not yield them."""

    steady: float = math.nan
    """Mean over the window of the steady state, minus the mean before the step, in the unit of the quantity."""
    response_time: float = math.nan
    """From the reference time to 90 % of `steady`, s."""
    peak: float = math.nan
    """Largest value after the step, in the direction and the unit of `steady`; `steady` if there is no overshoot."""
    peak_response_time: float = math.nan
    """From the reference time to the peak, s; NaN if the response does not overshoot."""
    overshoot: float = math.nan
    """(`peak` - `steady`) / `steady`; 0 if the response does not overshoot."""
    unsteadiness: float = math.nan
    """Standard deviation in the window of the steady state, divided by the absolute value of `steady`."""


def mean_between(
    time: NDArray[np.float64], values: NDArray[np.float64], begin: float, end: float
) -> tuple[float, float]:
    """Mean and standard deviation of a signal between two times, s; NaN if there is no sample."""
    samples = values[(time >= begin) & (time <= end)]
    return (float(samples.mean()), float(samples.std())) if len(samples) else (float("nan"), float("nan"))


def reference_time(
    time: NDArray[np.float64], steering: NDArray[np.float64], before: tuple[float, float], steady: tuple[float, float]
) -> float:
    """Time at which the steering has passed half of its step, s; NaN if there is no step.

    `time`, `steering`: s and steering-wheel angle, shape (n,); `before`, `steady`: begin and end of the windows over
    which the angles before and after the step are averaged, s.
    """
    first, last = mean_between(time, steering, *before)[0], mean_between(time, steering, *steady)[0]
    return crossing(time, steering, 0.5 * (first + last), before[1])


def step_response(
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    reference: float,
    before: tuple[float, float],
    steady: tuple[float, float],
) -> StepResponse:
    """Measures of the response of one quantity.

    `time`, `values`: shape (n,); `reference`: reference time, s; `before`, `steady`: begin and end of the windows
    before the step and of the steady state, s. All measures are NaN if the record ends before the end of the steady
    window, or the quantity does not change.

    Notes
    -----
    The peak is interpolated between samples. An excess below 1 % of the steady value is not an overshoot: the
    response still settles, or the car loses speed in the turn.
    """
    if not np.isfinite(reference) or len(time) < 3 or time[-1] < steady[1] - 1e-6 or not np.isfinite(values).all():
        return StepResponse()
    initial = mean_between(time, values, *before)[0]
    mean, deviation = mean_between(time, values, *steady)
    final = mean - initial
    if not np.isfinite(final) or final == 0.0:
        return StepResponse()
    relative = (values - initial) / final
    response_time = crossing(time, relative, 0.9, before[1]) - reference
    first = int(np.searchsorted(time, before[1]))
    peak_time, peak = interpolated_peak(time[first:], relative[first:])
    overshoots = peak > 1.01
    return StepResponse(
        steady=final,
        response_time=response_time,
        peak=final * peak if overshoots else final,
        peak_response_time=peak_time - reference if overshoots else float("nan"),
        overshoot=peak - 1.0 if overshoots else 0.0,
        unsteadiness=deviation / abs(final),
    )


def step_of_steering(
    time: NDArray[np.float64],
    steering: NDArray[np.float64],
    signals: Mapping[str, NDArray[np.float64]],
    before: tuple[float, float],
    steady: tuple[float, float],
) -> dict[str, Any]:
    """The `angle` of the step, rad, its `rise` time from 10 to 90 %, s, and the response of each signal by name.

    See `reference_time` for the arguments. Numbers are NaN if the record ends before the end of the steady window.
    """
    angle = rise = reference = math.nan
    if len(time) and time[-1] >= steady[1] - 1e-6:
        first = mean_between(time, steering, *before)[0]
        angle = mean_between(time, steering, *steady)[0] - first
        reference = reference_time(time, steering, before, steady)
    if angle == 0.0 or not math.isfinite(reference):
        angle = math.nan
    else:
        fraction = (steering - first) / angle
        rise = float(time[np.argmax(fraction >= 0.9)] - time[np.argmax(fraction >= 0.1)])
    responses = {name: step_response(time, x, reference, before, steady) for name, x in signals.items()}
    return {"angle": angle, "rise": rise, **responses}
