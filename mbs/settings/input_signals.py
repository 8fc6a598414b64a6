"""Inputs over time: a constant, a function of time, or a table."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.message_text import unit_text
from mbs.common.checks import is_number, numbers, shown
from mbs.kernel.binding.instance import Instance
from mbs.settings.input_breaks import AT_END, Table, distinct_times, function_breaks, input_breaks

Signal: TypeAlias = "float | Callable[[float], float] | tuple[ArrayLike, ArrayLike]"


class InputSignals:
    """Values of the named inputs of a System at given times.

    Parameters
    ----------
    signals : mapping of str to signal
        Per input a constant, a function of time in s, or a pair (times, values) of equal length: linear in between,
        held outside. A time given twice is a jump; at this time the input has the value before the jump, as the step
        that ends there lies before it. A function depends on time alone, because `breaks` samples it ahead. An input
        of whole numbers keeps each value of a table until the next one.
    declared : sequence of mapping
        Entries `name`, `unit`, `min`, `max` (None: open), `whole` of every input of the System, in order.
    """

    def __init__(self, signals: Mapping[str, Signal], declared: list[dict[str, Any]]) -> None:
        self._names = [str(d["name"]) for d in declared]
        self._units = [str(d["unit"]) for d in declared]
        self._min = np.array([-np.inf if d["min"] is None else d["min"] for d in declared], float)
        self._max = np.array([np.inf if d["max"] is None else d["max"] for d in declared], float)
        self._whole = np.array([bool(d.get("whole")) for d in declared])
        self._signals: dict[int, Signal] = {}
        self._jumps: dict[int, list[tuple[float, float]]] = {}
        for name, given in signals.items():
            if not isinstance(name, str) or name not in self._names:
                available = ", ".join(self._names) or "none"
                raise ValueError(f"There is no input {shown(name)}; the System has: {available}.")
            i = self._names.index(name)
            signal = _check_signal(name, given)
            if self._whole[i] and isinstance(signal, tuple):
                self._check(i, *_table(signal))
                signal = _staircase(signal)
            self._signals[i] = signal

    def columns(self) -> list[int]:
        """Indices of the inputs with a signal."""
        return list(self._signals)

    def breaks(self, t0: float, t_end: float, h: float) -> NDArray[np.float64]:
        """Find the times, s, at which steps of `h` from `t0` are divided; store jumps of functions for `attach`."""
        tables = [_table(signal) for signal in self._signals.values() if isinstance(signal, tuple)]
        break_times = [input_breaks(tables, t0, t_end, h)]
        for i, signal in self._signals.items():
            if callable(signal):
                times, self._jumps[i] = function_breaks(signal, t0, t_end, h)
                break_times.append(times)
        return distinct_times(break_times, t_end, h)

    def points(self) -> list[float]:
        """Times of the tables, and of the jumps of functions found by `breaks`, s."""
        tables = [t for s in self._signals.values() if isinstance(s, tuple) for t in _table(s)[0].tolist()]
        return tables + [before for jumps in self._jumps.values() for before, _ in jumps]

    @property
    def has_functions(self) -> bool:
        """Whether any input is a function of time."""
        return any(callable(signal) for signal in self._signals.values())

    def check(self, index: int, t: float, value: float) -> None:
        """Raise `ValueError` if a value at time `t`, s, is not finite, not whole as required, or outside the limits."""
        self._check(index, np.array([t]), np.array([value]))

    def at(self, t: NDArray[np.float64], tolerance: float, after_jump: bool = False) -> NDArray[np.float64]:
        """Values at times `t` (n,), shape (n, number of signals), in the order of `columns`.

        Times within `tolerance` (s) of a jump are at the jump; `after_jump`: take the value after it.
        """
        values = np.empty((len(t), len(self._signals)))
        for k, (i, signal) in enumerate(self._signals.items()):
            if callable(signal):
                values[:, k] = [_function_value(self._names[i], signal, float(time)) for time in t]
            elif isinstance(signal, tuple):
                values[:, k] = _interpolate(t, np.asarray(signal[0]), np.asarray(signal[1]), tolerance, after_jump)
            else:
                values[:, k] = signal
            self._check(i, t, values[:, k])
        return values

    def attach(self, instance: Instance, t0: float, t_end: float, tolerance: float) -> None:
        """Attach the signals to the kernel, which evaluates them at the stages of its method, from `t0` to `t_end`, s.

        Without functions of time no step calls Python. `instance.set_input_function(None)` detaches them.
        """
        if not self._signals:
            return
        for i, signal in self._signals.items():
            if not callable(signal):
                times, values = _table(signal)
                if not np.isfinite(values).all():
                    self._check(i, times, values)
                inside = times[(times >= t0 - tolerance) & (times <= t_end + tolerance)]
                ends = np.array([t0, t_end])
                self._check(i, ends, _interpolate(ends, times, values, tolerance, after_jump=False))
                for after in (False, True):
                    self._check(i, inside, _interpolate(inside, times, values, tolerance, after))
        if not self.has_functions:
            instance.set_input_tables({i: _table(signal) for i, signal in self._signals.items()}, tolerance)
            return
        evaluators = [(i, self._evaluator(i, signal, tolerance)) for i, signal in self._signals.items()]

        def function(t: float, after: bool, values: Any) -> None:
            for i, value in evaluators:
                values[i] = value(t, after)

        instance.set_input_function(function)

    def start_values(self, t0: float, h: float) -> dict[str, float]:
        """Values at the start `t0` of steps of `h`, s, by name; at a jump the value after it."""
        values = self.at(np.array([t0]), AT_END * h, after_jump=True)[0].tolist()
        return {self._names[i]: value for i, value in zip(self._signals, values, strict=True)}

    def attach_to_steps(self, instance: Instance, t0: float, t_end: float, h: float) -> None:
        """Attach the signals for steps of `h`, s, which end early at jumps and peaks of signals."""
        breaks = self.breaks(t0, t_end, h)
        self.attach(instance, t0, t_end, AT_END * h)
        instance.set_input_breaks(breaks)

    def _evaluator(self, i: int, signal: Signal, tolerance: float) -> Callable[[float, bool], float]:
        """Function of time, s, and of whether the value after a jump is taken, that returns the value of one signal."""
        low, high, whole = float(self._min[i]), float(self._max[i]), bool(self._whole[i])
        if callable(signal):
            jumps = self._jumps.get(i, [])
            before = [jump[0] for jump in jumps]

            def evaluate_function(t: float, after: bool) -> float:
                k = bisect_left(before, t - tolerance)
                if k < len(before) and before[k] <= t + tolerance:
                    t = jumps[k][after]
                value = _function_value(self._names[i], signal, t)
                if not low <= value <= high or math.isinf(value) or (whole and value != math.floor(value)):
                    self._check(i, np.array([t]), np.array([value]))
                return value

            return evaluate_function
        times, values = (column.tolist() for column in _table(signal))

        def interpolate_table(t: float, after: bool) -> float:
            right = bisect_right(times, t + tolerance) if after else bisect_left(times, t - tolerance)
            if right == 0 or right == len(times):
                return float(values[right and -1])
            start, span = times[right - 1], times[right] - times[right - 1]
            fraction = min(1.0, max(0.0, (t - start) / span)) if span > 0.0 else 0.0
            return float(values[right - 1] + fraction * (values[right] - values[right - 1]))

        return interpolate_table

    def _check(self, i: int, t: NDArray[np.float64], values: NDArray[np.float64]) -> None:
        """Raise `ValueError` for the first of `values` at times `t`, s, that input `i` cannot have."""
        inside = (values >= self._min[i]) & (values <= self._max[i]) & np.isfinite(values)
        is_valid = inside & (values == np.floor(values)) if self._whole[i] else inside
        if not is_valid.all():
            k = int(np.argmin(is_valid))
            if inside[k]:
                requirement = "be a whole number"
            elif np.isfinite(values[k]):
                requirement = f"lie between {self._min[i]:g} and {self._max[i]:g}"
            else:
                requirement = "be finite"
            value = f"{values[k]:g}{unit_text(self._units[i])}"
            raise ValueError(f"Input {self._names[i]!r} is {value} at t = {t[k]:g} s; it must {requirement}.")


def _table(signal: Signal) -> Table:
    """Times and values of a signal that is not a function; a constant has one point."""
    if isinstance(signal, tuple):
        return np.array(signal[0], float), np.array(signal[1], float)
    return np.zeros(1), np.array([signal], float)


def _staircase(table: tuple[ArrayLike, ArrayLike]) -> Table:
    """Table that holds each value until the next time and jumps there."""
    times, values = _table(table)
    return np.repeat(times, 2)[1:], np.repeat(values, 2)[:-1]


def _function_value(name: str, signal: Callable[[float], float], t: float) -> float:
    """Value of an input function at time `t`, s."""
    value = signal(t)
    if not is_number(value):
        raise ValueError(f"The function of input {name!r} gives {shown(value)} at t = {t:g} s; it must give a number.")
    return float(value)


def _check_signal(name: str, signal: Signal) -> Signal:
    """Return a signal with floats; raise `ValueError` if it is not a constant, function or table."""
    if callable(signal):
        return signal
    if not isinstance(signal, tuple):
        if not is_number(signal):
            raise ValueError(
                f"Input {name!r} is {shown(signal)}; it must be a number, a function of time or a tuple "
                "(times, values)."
            )
        return float(signal)
    if len(signal) != 2:
        raise ValueError(f"The table of input {name!r} has {len(signal)} parts; it must be a pair (times, values).")
    times, values = (numbers(column, f"the table of input {name!r}") for column in signal)
    if times.ndim != 1 or times.shape != values.shape or len(times) == 0:
        raise ValueError(
            f"The table of input {name!r} has times of shape {times.shape} and values of shape {values.shape}; "
            "both must be lists of the same length."
        )
    if not np.isfinite(times).all() or (np.diff(times) < 0.0).any():
        raise ValueError(f"The times of input {name!r} must be finite and must not decrease.")
    if (thrice := times[2:] == times[:-2]).any():
        raise ValueError(
            f"The table of input {name!r} has more than two values at t = {times[2:][thrice][0]:g} s; a jump has two, "
            "before and after it."
        )
    if not np.isfinite(values).all():  # checked here, as interpolation would make it NaN at other times
        k = int(np.argmin(np.isfinite(values)))
        raise ValueError(f"The table of input {name!r} has {values[k]:g} at t = {times[k]:g} s; it must be finite.")
    return times, values


def _interpolate(
    t: NDArray[np.float64], times: NDArray[np.float64], values: NDArray[np.float64], tolerance: float, after_jump: bool
) -> NDArray[np.float64]:
    """Values of a table at times `t` (n,), s; `tolerance`, `after_jump`: as in `InputSignals.at`."""
    if after_jump:
        right = np.searchsorted(times, t + tolerance, side="right")
    else:
        right = np.searchsorted(times, t - tolerance, side="left")
    left = np.clip(right - 1, 0, len(times) - 1)
    right = np.clip(right, 0, len(times) - 1)
    span = times[right] - times[left]
    fraction = np.where(span > 0.0, (t - times[left]) / np.where(span > 0.0, span, 1.0), 0.0)
    interpolated: NDArray[np.float64] = values[left] + np.clip(fraction, 0.0, 1.0) * (values[right] - values[left])
    return interpolated
