"""Observed order of convergence and extrapolation of runs with shorter steps."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from mbs.kernel.header.limits import WRONG_ERROR
from mbs.kernel.header.structures import ComparedFields
from mbs.results.accuracy import Accuracy
from mbs.results.comparison import Compared, differences
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import Settings


def observed_order(
    first_difference: float, near_difference: float, near_divisor: int, finest_divisor: int, method_order: float
) -> float:
    """Observed order of three runs, from one, the order behind an abrupt event, to `method_order`.

    `first_difference`, `near_difference`: differences of the first run, and of that with its step over `near_divisor`,
    from the run with its step over `finest_divisor`.
    """

    def residual(order: float) -> float:
        return float(
            near_difference * (finest_divisor**order - 1.0)
            - first_difference * ((finest_divisor / near_divisor) ** order - 1.0)
        )

    if residual(method_order) <= 0.0:
        return method_order
    return float(brentq(residual, 1.0, method_order)) if residual(1.0) < 0.0 else 1.0


def may_change_verdict(known: Accuracy, errors: Mapping[str, float]) -> bool:
    """Whether the errors of a refined run could change the verdict on the errors of the first run.

    `known`: errors of the first run by the refined one; `errors`: errors of the refined run relative to the range, by
    unit.
    """
    margins = [(error - WRONG_ERROR, errors.get(unit, 0.0)) for unit, error in known.units.items()]
    surely_wrong = any(margin >= error for margin, error in margins)
    return not surely_wrong and any(-margin < error for margin, error in margins)


def extrapolate_error(
    known: Accuracy,
    tables: Sequence[Mapping[str, NDArray[np.float64]]],
    compared: Mapping[str, Compared],
    before: Mapping[str, ComparedFields] | None,
    length: float,
) -> tuple[Accuracy, dict[str, float]]:
    """Error against the limit of refined runs, by Richardson's extrapolation with the order of the default method.

    That order holds after abrupt events too: stops are located, and parts of steps shrink with the step.

    `tables`: samples (n,), by name, of the run and of the last two refined ones, of which the last has half the step;
    `before`, `length`: as in `Comparison`. Result: the sizes of the sensors too, see `Comparison.sizes`.
    """
    run, coarse, fine = tables
    weight = 1.0 / (2.0 ** METHOD_TABLE[Settings.method].order - 1.0)
    limit = {name: fine[name] + weight * what.change(coarse[name], fine[name]) for name, what in compared.items()}
    units, sensors, sizes = differences(run, limit, compared, before, length)
    return replace(known, units=units, sensors=sensors), sizes
