"""Two motions of a System compared at samples: what they differ by, and what two of them say of a third."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from mbs.results.accuracy import WARNED_ERROR, Accuracy
from mbs.results.judged import ALIKE, Judged, is_open, rows_judged, sizes_of

Array = NDArray[np.float64]
WIDTH = 3  # samples: of the means of loads that are compared, and by how many one run may be late
EVENT_ORDER = 2.0  # behind abrupt events: of ALi3-P, where stops are located and parts of steps shrink with the step


def differences(
    coarse: Mapping[str, Array],
    fine: Mapping[str, Array],
    judged: Mapping[str, Judged],
    before: Mapping[str, Array] | None,
    length: float,
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Largest differences of two runs at samples, and of loads between them.

    Rates and the forces of motors count where no place moves by itself: those that guides prescribe are the same to
    round-off in both.

    Returns
    -------
    units : dict of str to float
        Largest difference over its size, per unit; units in which nothing moves are left out.
    sensors : dict of str to float
        Largest difference per sensor.
    sizes : dict of str to float
        See `sizes_of`, of the finer run.
    """
    sizes = sizes_of(fine, judged, length, before)
    gaps = {name: _gap(coarse[name], fine[name], judged[name]) for name in sizes}
    if is_open(judged) and any(judged[name].place and gaps[name] > ALIKE * size for name, size in sizes.items()):
        sizes = {name: size for name, size in sizes.items() if judged[name].always}
        gaps = {name: gaps[name] for name in sizes}
    units: dict[str, float] = {}
    for name, size in sizes.items():
        units[judged[name].unit] = max(gaps[name] / size, units.get(judged[name].unit, 0.0))
    return units, gaps, sizes


def _gap(one: Array, other: Array, what: Judged) -> float:
    rows = rows_judged(what, len(one))
    gap = float(what.apart(one[rows], other[rows]).max())
    return max(gap, missed_load(one, other)) if what.load else gap


def missed_load(one: Array, other: Array) -> float:
    """Largest load of one run, or lack of it, that the other does not have within `WIDTH` samples.

    Compared are means of `WIDTH` samples: a landing that comes a sample later, or whose peak lies between two samples,
    has the same mean. Shorter runs have none.

    `one`, `other`: the load at the same samples, shape (n,).
    """
    if len(one) < 2 * WIDTH:
        return 0.0
    means = [uniform_filter1d(load, WIDTH, mode="nearest") for load in (one, other)]
    gap = 0.0
    for a, b in (means, means[::-1]):
        most = maximum_filter1d(b, 2 * WIDTH + 1, mode="nearest")
        least = -maximum_filter1d(-b, 2 * WIDTH + 1, mode="nearest")
        gap = max(gap, float(np.max(a - most)), float(np.max(least - a)))
    return gap


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
