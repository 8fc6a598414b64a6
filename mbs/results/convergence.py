"""Observed order of convergence, and whether the error of a refined run could change a verdict."""

from collections.abc import Mapping

from scipy.optimize import brentq

from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.accuracy import Accuracy


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
