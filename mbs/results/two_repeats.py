"""The error of a run by two repeats, where it falls more slowly with the step than the order of the method says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mbs.results.accuracy import Accuracy

SLOW, SLOWEST = 1.3, 0.75  # orders: below the first one two repeats are believed more than the method's, to the second
TRIED = np.linspace(SLOW, SLOWEST, 56)


def by_two_repeats(first: Accuracy, second: Accuracy, ratio: float) -> Accuracy:
    """The error by the second of two repeats, with the order that both show where that is far below the method's.

    Peaks of forces of contacts have no order: where they are judged, the second repeat counts.

    Parameters
    ----------
    first, second : Accuracy
        By steps that are shorter `ratio` times and twice that.
    """
    if not first.error or not second.error or first.order is None or second.order is None or "N" in second.units:
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
