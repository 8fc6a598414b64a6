"""Loads and slips of the four wheels from a recorded run."""

import numpy as np
from numpy.typing import NDArray

from hosts.common.wheels import WHEELS
from hosts.driving.result import Result

LIFTED = 1.0
"""Load up to which a wheel is off the road, N; above rounding errors of solvers."""


def at_wheels(result: Result, quantity: str) -> NDArray[np.float64] | None:
    """A quantity of the four wheels in the order of `WHEELS`, shape (n, 4); None if a wheel does not have it.

    `quantity`: such as ``Fz`` of ``wheel_FL.Fz``.
    """
    names = [f"wheel_{wheel}.{quantity}" for wheel in WHEELS]
    return np.column_stack([result[name] for name in names]) if all(name in result for name in names) else None


def lifted_wheels(loads: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether wheels are off the road, shape (n, 4). `loads`: normal forces, N, shape (n, 4)."""
    return np.asarray(loads <= LIFTED)


def duration(time: NDArray[np.float64], state: NDArray[np.bool_]) -> float:
    """Duration for which a condition holds, s: the sum of the steps at whose ends it holds.

    `time`: s, shape (n,); `state`: whether the condition holds, shape (n,).
    """
    return float(np.diff(time)[state[1:]].sum())
