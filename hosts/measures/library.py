"""The functions that expressions of measures can use, by name."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.integrate import trapezoid

from hosts.common.errors import HostError
from hosts.common.wheels import WHEELS
from hosts.driving.result import Result
from hosts.measures.braking import (
    corrected_to,
    locked,
    mean_fully_developed_deceleration,
    stopping_distance,
    time_to_reach,
    travelled,
)
from hosts.measures.impact import fall_time, first_contact, rebound, settling_time, weight_from_momentum
from hosts.measures.vibration import largest_running_rms, vibration_dose, weighted
from hosts.measures.wheels import at_wheels, duration, lifted_wheels

_MIN_POINTS = 5
_MIN_SPAN = 0.8


@dataclass(frozen=True)
class Gradient:
    """A regression line."""

    slope: float
    """NaN if there is no line."""
    intercept: float
    """NaN if there is no line."""
    error: float
    """Standard error of the slope."""


NONE = Gradient(math.nan, math.nan, math.nan)
"""The gradient if no line can be fitted."""


def gradient(x: NDArray[np.float64], y: NDArray[np.float64], low: float, high: float) -> Gradient:
    """Regression line through the points with x in a range, with equal weight of all parts of the range.

    `x`, `y`: shape (n,), points that are not finite are ignored; `low`, `high`: range of x. Returns `NONE` where the
    points do not span most of the range.
    """
    selected = np.isfinite(x) & np.isfinite(y) & (x >= low) & (x <= high)
    if selected.sum() < _MIN_POINTS or np.ptp(x[selected]) < _MIN_SPAN * (high - low):
        return NONE
    # With a constant rise of the speed, points are denser at low accelerations; means over bins of x are not.
    edges = np.linspace(low, high, max(_MIN_POINTS, min(30, int(selected.sum()) // 4)) + 1)
    bin_x, bin_y = (
        np.asarray(stats.binned_statistic(x[selected], v[selected], "mean", edges).statistic) for v in (x, y)
    )
    finite = np.isfinite(bin_x)
    if finite.sum() < _MIN_POINTS - 2:
        return NONE
    line = stats.linregress(bin_x[finite].tolist(), bin_y[finite].tolist())
    return Gradient(float(line.slope), float(line.intercept), float(line.stderr))


def _wheels(result: Result, quantity: str) -> NDArray[np.float64]:
    """A quantity of the four wheels, shape (n, 4). Raises `HostError` if a wheel does not have it."""
    values = at_wheels(result, quantity)
    if values is None:
        raise HostError(f"The car does not provide wheel_{WHEELS[0]}.{quantity} and the like.")
    return values


def _array_function(function: Callable[[Any], Any]) -> Callable[[Any], float]:
    """The function of an array, but NaN for an empty array."""
    return lambda values: float(function(values)) if np.size(values) else math.nan


def _array_or_numbers_function(
    of_numbers: Callable[[Any], float], of_array: Callable[[Any], Any]
) -> Callable[..., float]:
    """`_array_function` for one argument, `of_numbers` for several."""
    return lambda *values: float(of_numbers(values)) if len(values) > 1 else _array_function(of_array)(*values)


LIBRARY: Mapping[str, Callable[..., Any]] = {
    "abs": np.abs,
    "all": np.all,
    "any": np.any,
    "argmax": np.argmax,
    "cos": math.cos,
    "degrees": np.degrees,
    "derivative": lambda x, time: np.gradient(x, time) if len(time) > 1 else np.zeros(1),
    "farthest": lambda values, x: max(values, key=lambda v: abs(v - x)) if values else math.nan,
    "fit": np.polyfit,
    "float": float,
    "interp": lambda x, time, values: float(np.interp(x, time, values)),
    "isfinite": math.isfinite,
    "isnan": math.isnan,
    "join": ", ".join,
    "leading": lambda flags: int(np.cumprod(flags).sum()),
    "len": len,
    "max": _array_or_numbers_function(max, np.max),
    "maximum": np.maximum,
    "mean": _array_function(np.mean),
    "min": _array_or_numbers_function(min, np.min),
    "range": _array_function(np.ptp),
    "radians": math.radians,
    "round": round,
    "row_at": lambda time, t: min(int(np.searchsorted(time, t)), len(time) - 1),
    "sign": lambda x: math.copysign(1.0, x),
    "sin": math.sin,
    "sorted": sorted,
    "sqrt": math.sqrt,
    "sum": np.sum,
    "thinned": lambda x, count: x[np.unique(np.linspace(0, max(len(x) - 1, 0), count).astype(int))] if len(x) else x,
    # of runs
    "corrected_to": corrected_to,
    "duration": duration,
    "fall_time": fall_time,
    "first_contact": first_contact,
    "gradient": gradient,
    "largest_running_rms": largest_running_rms,
    "lifted_wheels": lifted_wheels,
    "locked": locked,
    "mean_fully_developed_deceleration": mean_fully_developed_deceleration,
    "rebound": rebound,
    "settling_time": settling_time,
    "stopping_distance": stopping_distance,
    "time_to_reach": time_to_reach,
    "trapezoid": trapezoid,
    "travelled": travelled,
    "vibration_dose": vibration_dose,
    "weight_from_momentum": weight_from_momentum,
    "weighted": weighted,
    "wheels": _wheels,
}
"""Functions by name; ``max``, ``mean``, ``min`` and ``range`` of an empty array are NaN."""
