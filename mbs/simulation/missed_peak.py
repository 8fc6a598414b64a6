"""Peaks in tables of inputs that lie between two steps, so that a run does not know of them."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from mbs.settings.input_signals import Signal

LEAST = 0.1  # of the range of the table: a smaller peak is noise of a record
SEEN_BY = 6.0  # steps within a peak: by fewer its impulse is off by more than 3 %
FEWEST_SEEN_BY = 2.0  # by fewer it may not be seen at all
FINEST = 64  # times finer than the run, at most, is a repeat that shall see it


def missed_peak(inputs: Mapping[str, Signal] | None, t0: float, t_end: float, h: float) -> float:
    """Duration of the shortest peak in a table that goes beyond its values at both ends of a step, s; infinite where
    there is none.
    """
    found = math.inf
    for signal in (inputs or {}).values():
        if not isinstance(signal, tuple):
            continue
        t, x = (np.asarray(part, float) for part in signal)
        begin = t0 + h * np.floor((t - t0) / h + 1e-6)
        ends = np.array([np.interp(begin, t, x), np.interp(begin + h, t, x)])
        beyond = np.maximum(x - ends.max(axis=0), ends.min(axis=0) - x) > LEAST * np.ptp(x)
        lasting = np.diff(t, prepend=-math.inf) + np.diff(t, append=math.inf)
        found = min([found, *lasting[beyond & (lasting > 0.0) & (t > t0) & (t < t_end)]])
    return found
