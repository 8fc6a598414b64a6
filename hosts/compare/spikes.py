"""Finds single wrong samples of a log: values that no neighbour supports."""

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from hosts.common.display_units import number_in

_SIDE = 2  # neighbours on either side
_SPREADS = 4.0  # of the neighbours among themselves
_USUAL = 30.0  # median distances of a sample from its neighbours
_LONGEST = 0.0201  # s between neighbours: over a longer time a pedal or a wheel does move there and back


def spikes(time: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which samples no neighbour supports.

    `time`: increasing, s, shape (n,); `values`: shape (n,). Returns an array of shape (n,): a spike is further from the
    median of the two samples before and the two after it than four times the range of these four and 30 times the usual
    distance (median of those that are not zero) together. What lasts for two samples, and a step, is none; nor are the
    two samples at either end, and where neighbours are 20 ms apart or more nothing is looked for.
    """
    is_spike = np.zeros(len(values), dtype=np.bool_)
    if len(values) <= 2 * _SIDE:
        return is_spike
    count = len(values) - 2 * _SIDE
    shifts = [k for k in range(2 * _SIDE + 1) if k != _SIDE]
    neighbours = np.array([values[k : k + count] for k in shifts])
    distance = np.abs(values[_SIDE : _SIDE + count] - np.median(neighbours, axis=0))
    moving = distance[distance > 0.0]
    if not len(moving):
        return is_spike
    allowed = _SPREADS * np.ptp(neighbours, axis=0) + _USUAL * float(np.median(moving))
    steps = np.diff(time)
    near = np.maximum(steps[_SIDE - 1 : _SIDE - 1 + count], steps[_SIDE : _SIDE + count]) < _LONGEST
    is_spike[_SIDE : _SIDE + count] = (distance > allowed) & near
    return is_spike


def spike_text(what: str, unit: str, time: NDArray[np.float64], values: NDArray[np.float64]) -> str:
    """A sentence on the samples that are left out.

    `what`: the signal, as a user knows it; `time`, `values`: of the spikes, s, shape (k,), k > 0.
    """
    each = (f"{number_in(v, unit)} at {t:.6g} s" for t, v in zip(time, values, strict=True))
    samples = "sample" if len(time) == 1 else "samples"
    return f"{len(time)} {samples} of {what} that no neighbour supports left out: {some_of(each, 3)}."
