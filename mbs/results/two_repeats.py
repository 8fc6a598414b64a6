"""The error of a run by two or three repeats, where it falls more slowly with the step than the order of the method."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.results.accuracy import WRONG_ERROR, Accuracy, differences

Array = NDArray[np.float64]
FORCES = "N"

SLOW, SLOWEST = 1.3, 0.75  # orders: below the first one two repeats are believed more than the method's, to the second
TRIED = np.linspace(SLOW, SLOWEST, 56)
EVENT_ORDER = 1.5  # behind abrupt events: between that of the event's time, one, and that of the method


def by_two_repeats(first: Accuracy, second: Accuracy, ratio: float) -> Accuracy:
    """The error by the second of two repeats, with the order that both show where that is far below the method's.

    Peaks of forces of contacts have no order: where they are judged, the second repeat counts.

    Parameters
    ----------
    first, second : Accuracy
        By steps that are shorter `ratio` times and twice that.
    """
    if not first.error or not second.error or first.order is None or second.order is None or FORCES in second.units:
        return second
    # a repeat differs from the run by its error times one less the power of the ratio of the steps
    part = 1.0 - (2.0 * ratio) ** -second.order
    found = second.error * part / (first.error * (1.0 - ratio**-first.order))
    ratios = (1.0 - (2.0 * ratio) ** -TRIED) / (1.0 - ratio**-TRIED)
    if found <= ratios[0]:
        return second
    order = float(np.interp(found, ratios, TRIED))
    more = part / (1.0 - (2.0 * ratio) ** -order)
    return replace(
        second,
        order=order,
        units={unit: more * e for unit, e in second.units.items()},
        sensors={name: more * e for name, e in second.sensors.items()},
    )


def unsure(known: Accuracy, apart: Mapping[str, float]) -> bool:
    """Whether the repeat that gave the error may itself be off by so much that the verdict changes.

    Parameters
    ----------
    known : Accuracy
        By the finer of two repeats.
    apart : mapping of str to float
        What both differ by over the range, per unit: by order one the error of the finer one.
    """
    above = {unit: error - WRONG_ERROR for unit, error in known.units.items()}
    surely_wrong = any(more >= apart[unit] for unit, more in above.items())
    return not surely_wrong and any(-more < apart[unit] for unit, more in above.items())


def by_limit(known: Accuracy, tables: Sequence[Mapping[str, Array]], groups: Mapping[str, Sequence[str]]) -> Accuracy:
    """The error against what repeats tend to, by Richardson's extrapolation with `EVENT_ORDER`.

    Parameters
    ----------
    known : Accuracy
        By the last repeat.
    tables : sequence of Mapping of str to array of shape (n,)
        The run, and the last two repeats, of which the last has half the step, at the same samples.
    groups : mapping of str to sequence of str
        Names of what is compared, by unit.
    """
    run, coarse, fine = tables
    more = 1.0 / (2.0**EVENT_ORDER - 1.0)
    names = [name for unit in groups for name in groups[unit]]
    limit = {name: fine[name] + more * (fine[name] - coarse[name]) for name in names}
    units, sensors, _ = differences(run, limit, groups)
    return replace(known, order=EVENT_ORDER, units=units, sensors=sensors)
