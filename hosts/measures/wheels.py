"""Loads and slips of the four wheels from a recorded run."""

import numpy as np
from numpy.typing import NDArray

from hosts.common.wheels import WHEELS
from hosts.driving.result import Result

LIFTED = 1.0
"""A wheel with a load up to this has left the road, N: solvers leave rounding errors."""


def at_wheels(result: Result, quantity: str) -> NDArray[np.float64] | None:
    """One quantity of the four wheels. `quantity`: such as ``Fz`` of ``wheel_FL.Fz``.

    Result, shape (n, 4): in the order of `WHEELS`; None where a wheel lacks it.
    """
    names = [f"wheel_{wheel}.{quantity}" for wheel in WHEELS]
    return np.column_stack([result[name] for name in names]) if all(name in result for name in names) else None


def lifted_wheels(loads: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where wheels are off the road, shape (n, 4). `loads`: normal forces, N, shape (n, 4)."""
    return np.asarray(loads <= LIFTED)


def duration(time: NDArray[np.float64], state: NDArray[np.bool_]) -> float:
    """Duration for which a condition holds, s.

    `time`: in s, shape (n,); `state`: at the end of each step, shape (n,); a step counts whole if it ends so.
    """
    return float(np.diff(time)[state[1:]].sum())
