"""What steps do not see of tables of inputs: peaks between two of them, and when a jump comes."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from mbs.settings.input_signals import Table

LEAST = 0.1  # of the range of the table: a smaller change is noise of a record
SEEN_BY = 6.0  # steps within a peak: by fewer its impulse is off by more than 3 %
FEWEST_SEEN_BY = 2.0  # by fewer it may not be seen at all
FINEST = 64  # times finer than the run, at most, is a repeat that shall see it
QUICK = 0.125  # steps, in which a change is a jump
AT_END = 1e-6  # steps: behind a jump where one begins, before it where it ends, which see both sides of it
ON_TIME = 0.01  # steps: a jump so near to the end of one is at it
JUMP_PARTS = 4  # of a step where a jump comes within one: of half of it run and repeat may be off alike


def missed_peak(tables: Iterable[Table], t0: float, t_end: float, h: float) -> float:
    """Duration of the shortest peak in a table that goes beyond its values at both ends of a step, s; infinite where
    there is none.
    """
    found = math.inf
    for t, x in tables:
        phase = (t - t0) / h
        ends = np.array([np.interp(t0 + h * (np.floor(phase) + part), t, x) for part in (AT_END, 1.0 - AT_END)])
        beyond = np.maximum(x - ends.max(axis=0), ends.min(axis=0) - x) > LEAST * np.ptp(x)
        beyond &= np.abs(phase - np.round(phase)) > AT_END
        lasting = np.diff(t, prepend=-math.inf) + np.diff(t, append=math.inf)
        found = min([found, *lasting[beyond & (lasting > 0.0) & (t > t0) & (t < t_end)]])
    return found


def jumps_within_steps(tables: Iterable[Table], t0: float, t_end: float, h: float) -> bool:
    """Whether a table jumps between the ends of a step, which knows of it at its end."""
    for t, x in tables:
        jump = (np.abs(np.diff(x)) > LEAST * np.ptp(x)) & (np.diff(t) < QUICK * h) & (t[1:] > t0) & (t[:-1] < t_end)
        phase = (t[:-1][jump] - t0) / h
        if np.any(np.abs(phase - np.round(phase)) > ON_TIME):
            return True
    return False
