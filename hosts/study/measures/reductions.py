"""What makes one number of a signal over time; a closed list."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class Reduction:
    """A function of a signal, and maybe of a number."""

    apply: Callable[[Array, Array, float], float]
    """Of time (n,) s, signal (n,) and the number; n is at least 1."""
    unit: str | None = None
    """Of what it gives; by default that of the signal."""
    number: str = ""
    """What its second argument is; empty: it has none."""
    windowed: bool = True
    """Whether ``after`` and ``before`` can be given."""


def mean_over_time(time: Array, x: Array) -> float:
    """Integral by the trapezoidal rule over the duration; it does not change with the sampling as a plain mean does."""
    if len(x) == 1:
        return float(x[0])
    return float(np.trapezoid(x, time) / (time[-1] - time[0])) if time[-1] > time[0] else float(np.mean(x))


def _rms(time: Array, x: Array, _: float) -> float:
    return float(np.sqrt(mean_over_time(time, x**2)))


def _std(time: Array, x: Array, _: float) -> float:
    return float(np.sqrt(mean_over_time(time, (x - mean_over_time(time, x)) ** 2)))


REDUCTIONS: dict[str, Reduction] = {
    "max": Reduction(lambda time, x, _: float(x.max())),
    "min": Reduction(lambda time, x, _: float(x.min())),
    "range": Reduction(lambda time, x, _: float(x.max() - x.min())),
    "mean": Reduction(lambda time, x, _: mean_over_time(time, x)),
    "rms": Reduction(_rms),
    "std": Reduction(_std),
    "percentile": Reduction(lambda time, x, p: float(np.percentile(x, p)), number="a number from 0 to 100"),
    "time_of_max": Reduction(lambda time, x, _: float(time[x.argmax()]), "s"),
    "time_of_min": Reduction(lambda time, x, _: float(time[x.argmin()]), "s"),
    "initial": Reduction(lambda time, x, _: float(x[0]), windowed=False),
    "final": Reduction(lambda time, x, _: float(x[-1]), windowed=False),
    "value": Reduction(
        lambda time, x, t: float(np.interp(t, time, x)), number="a time of the run in s", windowed=False
    ),
}
