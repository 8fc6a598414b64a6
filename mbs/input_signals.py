"""Inputs over time: a constant, a function of time, or a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Signal: TypeAlias = "float | Callable[[float], float] | tuple[ArrayLike, ArrayLike]"


def unit_text(unit: str) -> str:
    """A unit behind a number: nothing for pure numbers."""
    return "" if unit in ("", "1") else f" {unit}"


class InputSignals:
    """Values of the named inputs of a System at given times.

    Parameters
    ----------
    signals : mapping of str to signal
        Per input a constant, a function of time in s, or a pair (times, values) of equal length: linear in between,
        held outside. A time given twice is a jump; at that very instant the value before it counts, because the step
        that ends there lies before it.
    declared : sequence of mapping
        Entries `name`, `unit`, `min`, `max` (None: open) of every input of the System, in order.
    """

    def __init__(self, signals: Mapping[str, Signal], declared: list[dict[str, Any]]) -> None:
        self._names = [str(d["name"]) for d in declared]
        self._units = [str(d["unit"]) for d in declared]
        self._min = np.array([-np.inf if d["min"] is None else d["min"] for d in declared], float)
        self._max = np.array([np.inf if d["max"] is None else d["max"] for d in declared], float)
        self._signals: dict[int, Signal] = {}
        for name, signal in signals.items():
            if name not in self._names:
                known = ", ".join(self._names) or "none"
                raise ValueError(f"There is no input {name!r}; the System has: {known}.")
            self._signals[self._names.index(name)] = _checked(name, signal)

    def columns(self) -> list[int]:
        """Numbers of the inputs that have a signal."""
        return list(self._signals)

    def at(self, t: NDArray[np.float64], tolerance: float, after_jump: bool = False) -> NDArray[np.float64]:
        """Values at times `t` (n,), shape (n, number of signals), in the order of `columns`.

        Times within `tolerance` (s) of a jump are at the jump; `after_jump` takes the value behind it.
        """
        values = np.empty((len(t), len(self._signals)))
        for k, (i, signal) in enumerate(self._signals.items()):
            if callable(signal):
                values[:, k] = [float(signal(float(time))) for time in t]
            elif isinstance(signal, tuple):
                values[:, k] = _interpolate(t, np.asarray(signal[0]), np.asarray(signal[1]), tolerance, after_jump)
            else:
                values[:, k] = signal
            self._check(i, t, values[:, k])
        return values

    def _check(self, i: int, t: NDArray[np.float64], values: NDArray[np.float64]) -> None:
        good = (values >= self._min[i]) & (values <= self._max[i]) & np.isfinite(values)
        if not good.all():
            k = int(np.argmin(good))
            right = f"lie between {self._min[i]:g} and {self._max[i]:g}" if np.isfinite(values[k]) else "be finite"
            value = f"{values[k]:g}{unit_text(self._units[i])}"
            raise ValueError(f"Input {self._names[i]!r} is {value} at t = {t[k]:g} s; it must {right}.")


def _checked(name: str, signal: Signal) -> Signal:
    if callable(signal):
        return signal
    if not isinstance(signal, tuple):
        return float(signal)
    if len(signal) != 2:
        raise ValueError(f"The table of input {name!r} has {len(signal)} parts; it must be a pair (times, values).")
    times, values = (np.asarray(part, float) for part in signal)
    if times.ndim != 1 or times.shape != values.shape or len(times) == 0:
        raise ValueError(
            f"The table of input {name!r} has times of shape {times.shape} and values of shape {values.shape}; "
            "both must be lists of the same length."
        )
    if not np.isfinite(times).all() or (np.diff(times) < 0.0).any():
        raise ValueError(f"The times of input {name!r} must be finite and must not decrease.")
    return times, values


def _interpolate(
    t: NDArray[np.float64], times: NDArray[np.float64], values: NDArray[np.float64], tolerance: float, after_jump: bool
) -> NDArray[np.float64]:
    if after_jump:
        right = np.searchsorted(times, t + tolerance, side="right")
    else:
        right = np.searchsorted(times, t - tolerance, side="left")
    left = np.clip(right - 1, 0, len(times) - 1)
    right = np.clip(right, 0, len(times) - 1)
    span = times[right] - times[left]
    share = np.where(span > 0.0, (t - times[left]) / np.where(span > 0.0, span, 1.0), 0.0)
    result: NDArray[np.float64] = values[left] + np.clip(share, 0.0, 1.0) * (values[right] - values[left])
    return result
