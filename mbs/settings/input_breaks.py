"""Break times of inputs: jumps and peaks of tables and functions, at which steps end early."""

import math
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from mbs.common.polyline import needed_points
from mbs.kernel.header.limits import WRONG_ERROR

Array = NDArray[np.float64]
Table = tuple[Array, Array]
MAX_DEPARTURE = 0.01  # of the range of the table: largest departure from a line in the parts of a divided step
AT_END = 1e-6  # steps: distance below which a time counts as the end of a step, or as another break
ROUND_OFF = 1e-6  # of the largest value: range of a constant with round-off (2e-7 in single precision)
HUGE = 1e300  # bound of values whose differences are finite
SAMPLES = 16  # per step: they meet a pulse of a function of a tenth of a step
BLOCK = 4096  # steps whose samples are in memory at a time


def input_breaks(tables: Iterable[Table], t0: float, t_end: float, h: float) -> Array:
    """Times, s, at which steps of `h` from `t0` are divided.

    A step in which a table departs from a straight line by more than `WRONG_ERROR` of its range, which is more than
    noise, is divided until its parts depart by no more than `MAX_DEPARTURE`.
    """
    return distinct_times([_table_breaks(t, x, _range(x), t0, t_end, h) for t, x in tables], t_end, h)


def function_breaks(
    function: Callable[[float], float], t0: float, t_end: float, h: float
) -> tuple[Array, list[tuple[float, float]]]:
    """Break times of a function, and pairs of the last time before and the first one after each of its jumps, s.

    A step in which the function is smooth is not divided. In runs of more than `BLOCK` steps the range of the function
    is taken from one sample per step.
    """
    edges = np.append(np.arange(t0, t_end - 0.5 * h, BLOCK * h), t_end)
    blocks = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
    range_samples = np.zeros(0)
    for begin, end in blocks if len(blocks) > 1 else []:
        x = _evaluate(function, np.linspace(begin, end, BLOCK + 1))
        valid = x[np.abs(x) < HUGE]
        range_samples = np.append(range_samples, valid)
        range_samples = np.array([range_samples.min(), range_samples.max()]) if len(range_samples) else range_samples
        if len(valid) < len(x):
            break
    break_times, jumps = [], list[tuple[float, float]]()
    for begin, end in blocks:
        t, x = sample_function(function, begin, end, h, range_samples)
        size = _range(np.append(x, range_samples))
        break_times.append(_table_breaks(t, x, size, begin, end, h, rough=True))
        jumps += _find_jumps(t, x, size, h)
        if t[-1] < end:
            break
    return distinct_times(break_times, t_end, h), jumps


def distinct_times(break_times: Iterable[Array], t_end: float, h: float) -> Array:
    """Ascending times before `t_end`, one of those within `AT_END` steps of `h`, s."""
    times = np.unique(np.concatenate([*break_times, [t_end]]))[:-1]
    return times[np.diff(times, prepend=-np.inf) > AT_END * h]


def sample_function(
    function: Callable[[float], float], t0: float, t_end: float, h: float, other_values: Array | tuple[()] = ()
) -> Table:
    """Table of a function of time with `SAMPLES` samples per step of `h`, s, bisected until it is straight in between.

    Bisection ends at a jump, when the halves are shorter than `AT_END` or two neighbouring floats. The table ends
    before a time at which the function fails. A function that changes between all samples, as noise does, is bisected
    once.

    `other_values`: values of the function elsewhere, for its range.
    """
    n = SAMPLES * max(1, int(np.ceil((t_end - t0) / h - AT_END)))
    t = t0 + (t_end - t0) * np.arange(n + 1) / n
    x = _evaluate(function, t)
    valid = max(1, int(np.argmin(np.r_[np.abs(x) < HUGE, False])))
    t, x = t[:valid], x[:valid]
    departs = np.abs(x[1:-1] - 0.5 * (x[:-2] + x[2:])) > WRONG_ERROR * _range(np.append(x, other_values))
    curved = np.flatnonzero(np.r_[departs, False] | np.r_[False, departs])
    a, b = (np.stack([t[curved + i], x[curved + i]]) for i in (0, 1))
    tables = [np.stack([t, x])]
    while 0 < a.shape[1] <= n and b[0, 0] - a[0, 0] > _jump_width(t_end, h):
        middle = 0.5 * (a + b)
        straight, middle[1] = middle[1].copy(), _evaluate(function, middle[0])
        tables.append(middle[:, np.abs(middle[1]) < HUGE])
        size = _range(np.append(np.concatenate(tables, axis=1)[1], other_values))
        departs = np.abs(middle[1] - straight) > MAX_DEPARTURE * size
        a, b = (
            np.concatenate([a[:, departs], middle[:, departs]], axis=1),
            np.concatenate([middle[:, departs], b[:, departs]], axis=1),
        )
    t, x = np.concatenate(tables, axis=1)
    order = np.argsort(t, kind="stable")
    return t[order], x[order]


def _evaluate(function: Callable[[float], float], times: Array) -> Array:
    """Values of a function at `times` (n,), s; NaN from the first time at which it fails."""
    values = np.full(len(times), np.nan)
    for k, time in enumerate(times.tolist()):
        try:
            values[k] = function(time)
        except Exception:  # a function of the user may raise anything
            break
    return values


def _table_breaks(t: Array, x: Array, size: float, t0: float, t_end: float, h: float, rough: bool = False) -> Array:
    """Break times, s, of one table with the range `size`; `rough`: only in steps in which it is not smooth."""
    times = [np.zeros(0)]
    phase = (t - t0) / h
    step = np.floor(phase)
    ends = t0 + h * (step + np.array([[AT_END], [1.0 - AT_END]]))
    begin, end = np.interp(ends, t, x)
    is_inside = (np.abs(phase - np.round(phase)) > AT_END) & (t > t0) & (t < t_end)
    is_break = is_inside & (np.abs(x - begin - (phase - step) * (end - begin)) > WRONG_ERROR * size)
    numbers = np.unique(step[is_break])
    for number in numbers[_is_rough(t, x, size, t0 + h * numbers, h)] if rough else numbers:
        first, last = np.searchsorted(step, [number, number + 1.0])
        inside = first + np.flatnonzero(is_inside[first:last])
        k = inside[0]
        points = np.r_[ends[0, k], t[inside], ends[1, k]], np.r_[begin[k], x[inside], end[k]]
        times.append(_needed_times(*points, MAX_DEPARTURE * size))
    return np.concatenate(times)


def _is_rough(t: Array, x: Array, size: float, begins: Array, h: float) -> NDArray[np.bool_]:
    """Whether a signal has a jump, a kink or a narrow peak in each step that begins at `begins` (n,), s.

    It has one if the error of its best cubic exceeds the error at a kink in the middle of a step with the departure
    `WRONG_ERROR` from a straight line, an eighth of the departure.
    """
    phases = np.linspace(AT_END, 1.0 - AT_END, SAMPLES + 1)
    cubic, _ = np.linalg.qr(np.vander(2.0 * phases - 1.0, 4))
    values = np.interp(begins[:, None] + h * phases, t, x)
    errors = np.abs(values - values @ cubic @ cubic.T).max(axis=1, initial=0.0)
    return np.asarray(errors > WRONG_ERROR / 8.0 * size, bool)


def _find_jumps(t: Array, x: Array, size: float, h: float) -> list[tuple[float, float]]:
    jumps = np.flatnonzero((np.diff(t) <= _jump_width(t[-1], h)) & (np.abs(np.diff(x)) > WRONG_ERROR * size))
    return [(float(t[k]), float(t[k + 1])) for k in jumps]


def _jump_width(t: float, h: float) -> float:
    """Distance of two times up to `t`, s, below which a change of the value is a jump."""
    return max(0.5 * AT_END * h, 2.0 * float(np.spacing(abs(t))))


def _range(x: Array) -> float:
    """Range of a signal; infinite if it is constant up to round-off, so that it has no departure."""
    size = float(np.ptp(x))
    return size if size > ROUND_OFF * float(np.abs(x).max()) else math.inf


def _needed_times(t: Array, x: Array, tolerance: float) -> Array:
    """Inner times of a table without which straight lines would depart from it by more than `tolerance`."""

    def departures(a: int, b: int) -> Array:
        return np.abs(x[a + 1 : b] - np.interp(t[a + 1 : b], t[[a, b]], x[[a, b]]))

    return t[needed_points(len(t), departures, tolerance)[1:-1]]
