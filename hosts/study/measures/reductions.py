"""Reductions of a signal over time to one number."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hosts.common.errors import HostError
from hosts.study.measures.quantity import Array, Quantity

SAME_TIME = 1e-9
"""Difference of equal times by rounding errors, s."""


class NotYieldedError(Exception):
    """Why a run does not yield a measure, as a sentence."""


@dataclass(frozen=True)
class Reduction:
    """A function of a signal and, for some, of a number."""

    name: str
    apply: Callable[[Array, Array, float], float]
    """Function of time, s, and signal, shape (n,), n at least 1, and of the number."""
    unit: str | None = None
    """Unit of the result; None: unit of the signal."""
    number: str = ""
    """Description of the second argument; empty: there is none."""
    greatest: float = math.inf
    """Largest value of the second argument."""
    windowed: bool = True
    """Whether ``after`` and ``before`` are allowed."""

    def __call__(self, *arguments: Quantity, **window: Quantity) -> Quantity:
        """Reduce a signal.

        Raises `HostError` if the arguments are not allowed, `NotYieldedError` if the signal has no sample in the
        window.
        """
        if len(arguments) != (2 if self.number else 1):
            arguments_text = f"a signal and {self.number}" if self.number else "one signal"
            raise HostError(f"{self.name} takes {arguments_text}; it was given {len(arguments)} arguments.")
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
        selected = (signal.time >= after - SAME_TIME) & (signal.time <= before + SAME_TIME)
        if not selected.any():
            raise NotYieldedError(f"The run from {begin:g} to {end:g} s has no sample for '{text}'.")
        result = self.apply(signal.time[selected], np.broadcast_to(signal.values, signal.time.shape)[selected], number)
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
    """Integral by the trapezoidal rule over the duration, which does not depend on uneven sampling."""
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
