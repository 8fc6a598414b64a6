"""Reductions of a signal over time to one number."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hosts.common.errors import HostError
from hosts.study.measures.quantity import Array, Quantity

SAME_TIME = 1e-9
"""s; times of a run add up with rounding errors."""


class NotYieldedError(Exception):
    """Why a run does not yield a measure, as a sentence."""


@dataclass(frozen=True)
class Reduction:
    """A function of a signal, and maybe of a number."""

    name: str
    apply: Callable[[Array, Array, float], float]
    """Of time (n,) s, signal (n,) and the number; n is at least 1."""
    unit: str | None = None
    """Of what it gives; by default that of the signal."""
    number: str = ""
    """What its second argument is; empty: it has none."""
    greatest: float = math.inf
    """Of its second argument."""
    windowed: bool = True
    """Whether ``after`` and ``before`` can be given."""

    def __call__(self, *arguments: Quantity, **window: Quantity) -> Quantity:
        """Reduce a signal.

        Raises `HostError`: the arguments are none of this function; `NotYieldedError`: the signal has no sample there.
        """
        if len(arguments) != (2 if self.number else 1):
            needs = f"a signal and {self.number}" if self.number else "one signal"
            raise HostError(f"{self.name} takes {needs}; it was given {len(arguments)} arguments.")
        signal, text = arguments[0], ", ".join(a.text for a in arguments)
        if signal.time is None:
            raise HostError(f"{self.name} takes a signal over time; '{signal.text}' is a number.")
        number = float(arguments[1].values) if self.number and arguments[1].time is None else math.nan
        if self.number and not 0.0 <= number <= min(self.greatest, np.finfo(float).max):
            raise HostError(f"the second argument of {self.name} is {arguments[1].text}, not {self.number}.")
        after, before = self._window(window)
        text = f"{self.name}({', '.join([text, *(f'{n}={q.text}' for n, q in window.items())])})"
        begin, end = signal.time[0], signal.time[-1]
        if self.name == "value" and not begin - SAME_TIME <= number <= end + SAME_TIME:
            raise NotYieldedError(f"The run ends at {end:g} s, before the {number:g} s of '{text}'.")
        inside = (signal.time >= after - SAME_TIME) & (signal.time <= before + SAME_TIME)
        if not inside.any():
            raise NotYieldedError(f"The run from {begin:g} to {end:g} s has no sample for '{text}'.")
        result = self.apply(signal.time[inside], np.broadcast_to(signal.values, signal.time.shape)[inside], number)
        return Quantity(text, np.asarray(result), self.unit or signal.unit)

    def _window(self, window: dict[str, Quantity]) -> tuple[float, float]:
        limits = {"after": -math.inf, "before": math.inf}
        for name, limit in window.items():
            if not self.windowed:
                raise HostError(f"{self.name} has no {name}.")
            if name not in limits:
                raise HostError(f"{self.name} has no {name}; it has after and before, times in s.")
            limits[name] = float(limit.values) if limit.time is None else math.nan
            if not 0.0 <= limits[name] < math.inf:
                raise HostError(f"{name} is {limit.text}, not a time of the run in s.")
        if limits["after"] >= limits["before"]:
            raise HostError(f"it is to begin after {limits['after']:g} s and to end before {limits['before']:g} s.")
        return limits["after"], limits["before"]


def mean_over_time(time: Array, x: Array) -> float:
    """Integral by the trapezoidal rule over the duration; it does not change with the sampling as a plain mean does."""
    if len(x) == 1:
        return float(x[0])
    return float(np.trapezoid(x, time) / (time[-1] - time[0])) if time[-1] > time[0] else float(np.mean(x))


def _rms(time: Array, x: Array, _: float) -> float:
    return float(np.sqrt(mean_over_time(time, x**2)))


def _std(time: Array, x: Array, _: float) -> float:
    return float(np.sqrt(mean_over_time(time, (x - mean_over_time(time, x)) ** 2)))


_ALL = (
    Reduction("max", lambda time, x, _: float(x.max())),
    Reduction("min", lambda time, x, _: float(x.min())),
    Reduction("range", lambda time, x, _: float(x.max() - x.min())),
    Reduction("mean", lambda time, x, _: mean_over_time(time, x)),
    Reduction("rms", _rms),
    Reduction("std", _std),
    Reduction(
        "percentile", lambda time, x, p: float(np.percentile(x, p)), number="a number from 0 to 100", greatest=100.0
    ),
    Reduction("time_of_max", lambda time, x, _: float(time[x.argmax()]), "s"),
    Reduction("time_of_min", lambda time, x, _: float(time[x.argmin()]), "s"),
    Reduction("initial", lambda time, x, _: float(x[0]), windowed=False),
    Reduction("final", lambda time, x, _: float(x[-1]), windowed=False),
    Reduction(
        "value", lambda time, x, t: float(np.interp(t, time, x)), number="a time of the run in s", windowed=False
    ),
)
REDUCTIONS = {reduction.name: reduction for reduction in _ALL}
