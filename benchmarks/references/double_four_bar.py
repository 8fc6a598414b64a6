"""Exact motion of the N-four-bar: the reduction to one angle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from mbs.scenes.double_four_bar import GRAVITY, START_SPEED


def exact(windows: int, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Position of B0, shape (n, 2), m: the cranks stay parallel, [(N+1)/3 + N] theta'' = [(N+1)/2 + N] g sin(theta)."""
    factor = ((windows + 1) / 2 + windows) / ((windows + 1) / 3 + windows) * GRAVITY
    solution = solve_ivp(
        lambda _, x: [x[1], factor * np.sin(x[0])],
        (0.0, t[-1]),
        [0.0, START_SPEED],
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        t_eval=t,
    )
    return np.column_stack([np.sin(solution.y[0]), np.cos(solution.y[0])])
