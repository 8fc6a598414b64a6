"""Where steps end early: at jumps and peaks of tables of inputs within them."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mbs.common.polyline import needed_points
from mbs.settings.input_signals import Table

LEAST = 0.05  # of the range of the table: a smaller departure is noise of a record
AT_END = 1e-6  # steps: what is so near to the end of one, or to another break, is at it


def input_breaks(tables: Iterable[Table], t0: float, t_end: float, h: float) -> NDArray[np.float64]:
    """Times, s, at which steps of `h` from `t0` are parted: in each part tables go straight, but for `LEAST`."""
    found = [t_end]
    for t, x in tables:
        phase, least = (t - t0) / h, LEAST * float(np.ptp(x))
        step = np.floor(phase)
        ends = t0 + h * (step + np.array([[AT_END], [1.0 - AT_END]]))
        begin, end = np.interp(ends, t, x)
        within = (np.abs(phase - np.round(phase)) > AT_END) & (t > t0) & (t < t_end)
        departs = within & (np.abs(x - begin - (phase - step) * (end - begin)) > least)
        for number in np.unique(step[departs]):
            inside = within & (step == number)
            k = int(np.argmax(inside))
            found.extend(_parted(np.r_[ends[0, k], t[inside], ends[1, k]], np.r_[begin[k], x[inside], end[k]], least))
    times = np.unique(found)[:-1]
    return times[np.diff(times, prepend=-np.inf) > AT_END * h]


def _parted(t: NDArray[np.float64], x: NDArray[np.float64], least: float) -> NDArray[np.float64]:
    """Times between the first and the last without which straight lines would miss a table by more than `least`."""

    def off(a: int, b: int) -> NDArray[np.float64]:
        return np.abs(x[a + 1 : b] - np.interp(t[a + 1 : b], t[[a, b]], x[[a, b]]))

    return t[needed_points(len(t), off, least)[1:-1]]
