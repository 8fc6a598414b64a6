"""Observed order of convergence, and extrapolation of runs with shorter steps."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mbs.kernel.header.limits import WRONG_ERROR
from mbs.kernel.header.structures import ComparedFields
from mbs.results.accuracy import Accuracy
from mbs.results.comparison import Compared, differences
from mbs.results.run_report import Report
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import Settings

LEAST_ORDER = 0.5  # measured: below, differences do not yet show the error


def measured_order(method: str, coarse: Report, fine: Report, ratio: float) -> float:
    """Order with which errors fall: that of the energy where both runs measured it, at most that of the method."""
    most = float(METHOD_TABLE[method].order)
    first, second = abs(coarse.energy_error), abs(fine.energy_error)
    if most > 2.0 or not (second > 0.0 and first > second):  # the quadrature of a work is of lower order
        return most
    return min(most, max(1.0, math.log(first / second) / math.log(ratio)))


def seen_order(first: float, near: float, parts: int, most_parts: int, most: float) -> float:
    """Order, from `LEAST_ORDER` to `most`, with which runs come nearer to what they tend to, of which one and that with
    its step in `parts` differ by `first` and `near` from that with its step in `most_parts`.
    """

    def more(order: float) -> float:
        return float(near * (most_parts**order - 1.0) - first * ((most_parts / parts) ** order - 1.0))

    if more(most) <= 0.0:
        return most
    return float(brentq(more, LEAST_ORDER, most)) if more(LEAST_ORDER) < 0.0 else LEAST_ORDER


def unsure(known: Accuracy, apart: Mapping[str, float]) -> bool:
    """Whether a run that is off by `apart` may change the verdict of the error that it gave, both over the range, per
    unit.
    """
    above = {unit: error - WRONG_ERROR for unit, error in known.units.items()}
    surely_wrong = any(more >= apart[unit] for unit, more in above.items())
    return not surely_wrong and any(-more < apart[unit] for unit, more in above.items())


def extrapolated(
    known: Accuracy,
    tables: Sequence[Mapping[str, NDArray[np.float64]]],
    compared: Mapping[str, Compared],
    before: Mapping[str, ComparedFields] | None,
    length: float,
) -> Accuracy:
    """The error against what refined runs tend to, by Richardson's extrapolation with the order of the default
    method, which keeps it behind abrupt events: stops are located, and parts of steps shrink with the step.

    `tables`: of the run and of the last two refined ones, of which the last has half the step, samples of shape (n,) by
    name; `before`, `length`: as of `Comparison`.
    """
    run, coarse, fine = tables
    weight = 1.0 / (2.0 ** METHOD_TABLE[Settings.method].order - 1.0)
    limit = {name: fine[name] + weight * what.change(coarse[name], fine[name]) for name, what in compared.items()}
    units, sensors, _ = differences(run, limit, compared, before, length)
    return replace(known, units=units, sensors=sensors)
