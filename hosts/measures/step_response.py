"""Response of a quantity to a step of the steering: times, overshoot, steady value, as ISO 7401 has them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.measures.filters import crossing
from hosts.measures.peak import top


@dataclass(frozen=True)
class StepResponse:
    """What is measured of one quantity; NaN where the record does not show it."""

    steady: float
    """Mean over the window of the steady state, less the mean before the step, in the unit of the quantity."""
    response_time: float
    """From the reference time to 90 % of `steady`, s."""
    peak: float
    """Largest value after the step, in the direction and the unit of `steady`; `steady` if there is no overshoot."""
    peak_response_time: float
    """From the reference time to the peak, s; NaN if the response does not overshoot."""
    overshoot: float
    """(`peak` - `steady`) / `steady`; 0 if the response does not overshoot."""
    unsteadiness: float
    """Standard deviation in the window of the steady state, in parts of the absolute value of `steady`."""


NOTHING = StepResponse(*6 * (float("nan"),))


def mean_between(
    time: NDArray[np.float64], values: NDArray[np.float64], begin: float, end: float
) -> tuple[float, float]:
    """Mean and standard deviation of a signal between two times, s; NaN if there is no sample."""
    samples = values[(time >= begin) & (time <= end)]
    return (float(samples.mean()), float(samples.std())) if len(samples) else (float("nan"), float("nan"))


def reference_time(
    time: NDArray[np.float64],
    steering: NDArray[np.float64],
    before: tuple[float, float],
    steady: tuple[float, float],
) -> float:
    """When the steering has passed half of its step.

    `time`, `steering`: s and the angle of the steering wheel, shape (n,); `before`, `steady`: beginning and end, s, of
    the windows over which the angles before and after the step are averaged. Result: in s; NaN if there is no step.
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

    `time`, `values`: shape (n,); `reference`: reference time, s; `before`, `steady`: beginning and end of the windows
    before the step and of the steady state, s. Result: all NaN where the record ends before the steady window, or the
    quantity does not change.

    Notes
    -----
    The peak is the largest sample improved by a parabola through it and its neighbours, so that the step of the record
    does not round its time. An excess below 1 % over the steady value is no overshoot: the response still settles, or
    the car loses speed in the turn.
    """
    if not np.isfinite(reference) or len(time) < 3 or time[-1] < steady[1] - 1e-6 or not np.isfinite(values).all():
        return NOTHING
    zero = mean_between(time, values, *before)[0]
    mean, deviation = mean_between(time, values, *steady)
    final = mean - zero
    if not np.isfinite(final) or final == 0.0:
        return NOTHING
    relative = (values - zero) / final
    response = crossing(time, relative, 0.9, before[1]) - reference
    first = int(np.searchsorted(time, before[1]))
    at, peak = top(time[first:], relative[first:])
    over = peak > 1.01
    return StepResponse(
        steady=final,
        response_time=response,
        peak=final * peak if over else final,
        peak_response_time=at - reference if over else float("nan"),
        overshoot=peak - 1.0 if over else 0.0,
        unsteadiness=deviation / abs(final),
    )


def step_of_steering(
    time: NDArray[np.float64],
    steering: NDArray[np.float64],
    signals: Mapping[str, NDArray[np.float64]],
    before: tuple[float, float],
    steady: tuple[float, float],
) -> dict[str, Any]:
    """The step of the steering, `angle`, rad, and `rise` from 10 to 90 %, s, and the response of each signal.

    See `reference_time` for the arguments. Numbers are NaN where the record ends before the steady state.
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
