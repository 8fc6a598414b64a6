"""The error of a run by three repeats, where it falls more slowly with the step than the order of the method."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.results.accuracy import WARNED_ERROR, Accuracy
from mbs.results.judged import Judged, differences

Array = NDArray[np.float64]
EVENT_ORDER = 1.75  # behind abrupt events: between that of the event's time, one, and that of the method, nearer to it


def unsure(known: Accuracy, apart: Mapping[str, float]) -> bool:
    """Whether the repeat that gave the error may itself be off by so much that the verdict changes.

    `known`: by the finer of two repeats; `apart`: what both differ by over the range, per unit: by order one the error
    of the finer one.
    """
    above = {unit: error - WARNED_ERROR for unit, error in known.units.items()}
    surely_wrong = any(more >= apart[unit] for unit, more in above.items())
    return not surely_wrong and any(-more < apart[unit] for unit, more in above.items())


def by_limit(
    known: Accuracy,
    tables: Sequence[Mapping[str, Array]],
    judged: Mapping[str, Judged],
    before: Mapping[str, Array] | None,
    length: float,
) -> Accuracy:
    """The error against what repeats tend to, by Richardson's extrapolation with `EVENT_ORDER`.

    Parameters
    ----------
    known : Accuracy
        By the last repeat.
    tables : sequence of Mapping of str to array of shape (n,)
        The run, and the last two repeats, of which the last has half the step, at the same samples.
    judged : mapping of str to Judged
        What is compared.
    before : mapping of str to ndarray or None
        The ends of what moved before, by name.
    length : float
        Of the model, m.
    """
    run, coarse, fine = tables
    more = 1.0 / (2.0**EVENT_ORDER - 1.0)
    limit = {name: fine[name] + more * (fine[name] - coarse[name]) for name in judged}
    units, sensors, _ = differences(run, limit, judged, before, length)
    return replace(known, units=units, sensors=sensors)
