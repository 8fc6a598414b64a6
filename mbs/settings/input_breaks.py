"""Times at which steps end early: jumps and peaks of tables and functions of inputs."""

import math
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from mbs.common.polyline import needed_points

Array = NDArray[np.float64]
Table = tuple[Array, Array]
LEAST = 0.05  # of the range of the table: a smaller departure is noise of a record
FINE = 0.01  # of the range: largest departure of the parts of a step that is divided
AT_END = 1e-6  # steps: what is so near to the end of one, or to another break, is at it
ROUND_OFF = 1e-6  # of the largest value: a smaller range is that of a constant; in single precision it is 2e-7
HUGE = 1e300  # differences of smaller values are finite
ASKED = 16  # times a step: a pulse of a function of a tenth of a step is met
BLOCK = 4096  # steps: of samples that are kept at a time


def input_breaks(tables: Iterable[Table], t0: float, t_end: float, h: float) -> Array:
    """Times, s, at which steps of `h` from `t0` are divided.

    A step in which a table departs from a straight line by more than `LEAST` is divided until its parts depart by no
    more than `FINE`.
    """
    return distinct([_breaks(t, x, _range(x), t0, t_end, h) for t, x in tables], t_end, h)


def function_breaks(
    function: Callable[[float], float], t0: float, t_end: float, h: float
) -> tuple[Array, list[tuple[float, float]]]:
    """Break times of a function, and the last time before and the first one after each of its jumps, s.

    A step in which the function is smooth is not divided. Samples are kept for `BLOCK` steps at a time; for a longer
    run the range is taken from one sample per step.
    """
    edges = np.append(np.arange(t0, t_end - 0.5 * h, BLOCK * h), t_end)
    blocks = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
    range_samples = np.zeros(0)
    for begin, end in blocks if len(blocks) > 1 else []:
        x = _ask(function, np.linspace(begin, end, BLOCK + 1))
        good = x[np.abs(x) < HUGE]
        range_samples = np.append(range_samples, good)
        range_samples = np.array([range_samples.min(), range_samples.max()]) if len(range_samples) else range_samples
        if len(good) < len(x):
            break
    break_times, jumping = [], list[tuple[float, float]]()
    for begin, end in blocks:
        t, x = sampled(function, begin, end, h, range_samples)
        size = _range(np.append(x, range_samples))
        break_times.append(_breaks(t, x, size, begin, end, h, rough=True))
        jumping += _jumps(t, x, size, h)
        if t[-1] < end:
            break
    return distinct(break_times, t_end, h), jumping


def distinct(found: Iterable[Array], t_end: float, h: float) -> Array:
    """Times before `t_end` in ascending order; of times within `AT_END` only one."""
    times = np.unique(np.concatenate([*found, [t_end]]))[:-1]
    return times[np.diff(times, prepend=-np.inf) > AT_END * h]


def sampled(
    function: Callable[[float], float], t0: float, t_end: float, h: float, seen: Array | tuple[()] = ()
) -> Table:
    """A function of time as a table, `ASKED` times a step of `h`, s, and in halves between these until it goes
    straight; `seen`: values that it has elsewhere.

    Halves of less than `AT_END`, or of two neighbouring numbers, have a jump between them. The table ends where the
    function fails, as the step then will that asks there; a function that changes between all samples, as noise does,
    is halved once.
    """
    n = ASKED * max(1, int(np.ceil((t_end - t0) / h - AT_END)))
    t = t0 + (t_end - t0) * np.arange(n + 1) / n
    x = _ask(function, t)
    good = max(1, int(np.argmin(np.r_[np.abs(x) < HUGE, False])))
    t, x = t[:good], x[:good]
    off = np.abs(x[1:-1] - 0.5 * (x[:-2] + x[2:])) > LEAST * _range(np.append(x, seen))
    uneven = np.flatnonzero(np.r_[off, False] | np.r_[False, off])
    a, b = (np.stack([t[uneven + i], x[uneven + i]]) for i in (0, 1))
    tables = [np.stack([t, x])]
    while 0 < a.shape[1] <= n and b[0, 0] - a[0, 0] > _apart(t_end, h):
        middle = 0.5 * (a + b)
        straight, middle[1] = middle[1].copy(), _ask(function, middle[0])
        tables.append(middle[:, np.abs(middle[1]) < HUGE])
        size = _range(np.append(np.concatenate(tables, axis=1)[1], seen))
        off = np.abs(middle[1] - straight) > FINE * size
        a, b = np.concatenate([a[:, off], middle[:, off]], axis=1), np.concatenate([middle[:, off], b[:, off]], axis=1)
    t, x = np.concatenate(tables, axis=1)
    order = np.argsort(t, kind="stable")
    return t[order], x[order]


def _ask(function: Callable[[float], float], times: Array) -> Array:
    """Values of a function; NaN from where it fails."""
    values = np.full(len(times), np.nan)
    for k, time in enumerate(times.tolist()):
        try:
            values[k] = function(time)
        except Exception:  # of a function of the user, whatever it raises
            break
    return values


def _breaks(t: Array, x: Array, size: float, t0: float, t_end: float, h: float, rough: bool = False) -> Array:
    """Break times of one table whose signal has the range `size`; `rough`: only in steps in which it is not smooth."""
    times = [np.zeros(0)]
    phase = (t - t0) / h
    step = np.floor(phase)
    ends = t0 + h * (step + np.array([[AT_END], [1.0 - AT_END]]))
    begin, end = np.interp(ends, t, x)
    within = (np.abs(phase - np.round(phase)) > AT_END) & (t > t0) & (t < t_end)
    departs = within & (np.abs(x - begin - (phase - step) * (end - begin)) > LEAST * size)
    numbers = np.unique(step[departs])
    for number in numbers[_rough(t, x, size, t0 + h * numbers, h)] if rough else numbers:
        first, behind = np.searchsorted(step, [number, number + 1.0])
        inside = first + np.flatnonzero(within[first:behind])
        k = inside[0]
        points = np.r_[ends[0, k], t[inside], ends[1, k]], np.r_[begin[k], x[inside], end[k]]
        times.append(_parted(*points, FINE * size))
    return np.concatenate(times)


def _rough(t: Array, x: Array, size: float, begins: Array, h: float) -> NDArray[np.bool_]:
    """Whether a signal has a jump, a kink or a narrow peak in each step.

    It has one if the error of its best cubic is that of a kink in the middle of a step that departs by `LEAST` from a
    straight line; that error is an eighth of the departure.
    """
    at = np.linspace(AT_END, 1.0 - AT_END, ASKED + 1)
    cubic, _ = np.linalg.qr(np.vander(2.0 * at - 1.0, 4))
    values = np.interp(begins[:, None] + h * at, t, x)
    missed = np.abs(values - values @ cubic @ cubic.T).max(axis=1, initial=0.0)
    return np.asarray(missed > LEAST / 8.0 * size, bool)


def _jumps(t: Array, x: Array, size: float, h: float) -> list[tuple[float, float]]:
    jumps = np.flatnonzero((np.diff(t) <= _apart(t[-1], h)) & (np.abs(np.diff(x)) > LEAST * size))
    return [(float(t[k]), float(t[k + 1])) for k in jumps]


def _apart(t: float, h: float) -> float:
    """Distance of two times up to `t` below which one value follows the other in a jump, s."""
    return max(0.5 * AT_END * h, 2.0 * float(np.spacing(abs(t))))


def _range(x: Array) -> float:
    """Range of a signal; infinite if it is constant up to round-off, so that nothing departs from it."""
    size = float(np.ptp(x))
    return size if size > ROUND_OFF * float(np.abs(x).max()) else math.inf


def _parted(t: Array, x: Array, least: float) -> Array:
    """Times between the first and the last without which straight lines would miss a table by more than `least`."""

    def off(a: int, b: int) -> Array:
        return np.abs(x[a + 1 : b] - np.interp(t[a + 1 : b], t[[a, b]], x[[a, b]]))

    return t[needed_points(len(t), off, least)[1:-1]]
