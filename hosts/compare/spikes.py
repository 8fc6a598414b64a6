"""Detects single wrong samples of a log: values that no neighbour supports."""

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from hosts.common.display_units import number_in

_NEIGHBOURS = 2  # on either side
_RANGES = 4.0  # of the neighbours
_MEDIAN_DISTANCES = 30.0  # of the samples from their neighbours
_MAX_INTERVAL = 0.0201  # s between neighbours: in a longer time a pedal or a wheel may move there and back


def spikes(time: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which samples no neighbour supports.

    `time`: increasing, s, shape (n,); `values`: shape (n,). Returns an array of shape (n,).

    Notes
    -----
    The distance of a spike from the median of the two samples before and the two after it exceeds four times their
    range plus 30 times the median distance (of those that are not zero). Two equal samples, a step, the two samples at
    either end, and samples more than 20 ms from a neighbour are not spikes.
    """
    is_spike = np.zeros(len(values), dtype=np.bool_)
    if len(values) <= 2 * _NEIGHBOURS:
        return is_spike
    count = len(values) - 2 * _NEIGHBOURS
    shifts = [k for k in range(2 * _NEIGHBOURS + 1) if k != _NEIGHBOURS]
    neighbours = np.array([values[k : k + count] for k in shifts])
    distance = np.abs(values[_NEIGHBOURS : _NEIGHBOURS + count] - np.median(neighbours, axis=0))
    nonzero = distance[distance > 0.0]
    if not len(nonzero):
        return is_spike
    threshold = _RANGES * np.ptp(neighbours, axis=0) + _MEDIAN_DISTANCES * float(np.median(nonzero))
    steps = np.diff(time)
    is_near = (
        np.maximum(steps[_NEIGHBOURS - 1 : _NEIGHBOURS - 1 + count], steps[_NEIGHBOURS : _NEIGHBOURS + count])
        < _MAX_INTERVAL
    )
    is_spike[_NEIGHBOURS : _NEIGHBOURS + count] = (distance > threshold) & is_near
    return is_spike


def spike_text(signal: str, unit: str, time: NDArray[np.float64], values: NDArray[np.float64]) -> str:
    """A sentence on the samples that are left out.

    `signal`: its label for a user; `time`, `values`: times and values of the spikes, s and `unit`, shape (k,), k > 0.
    """
    texts = (f"{number_in(v, unit)} at {t:.6g} s" for t, v in zip(time, values, strict=True))
    samples = "sample" if len(time) == 1 else "samples"
    return f"{len(time)} {samples} of {signal} that no neighbour supports left out: {some_of(texts, 3)}."
