"""Smooth table of a lookup-table body or number, and the check of its data."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import array, capital, is_number, shown
from mbs.common.errors import ModelError
from mbs.model.body import Body
from mbs.model.table_bodies import SmoothTable

Array = NDArray[np.float64]

FEWEST = 4
"""Points of a table along a coordinate."""
UNIFORM = 1e-9
"""How far points may be from equal spacing, parts of it."""
DRAWN = 1e-6
"""How far a table may be from the drawing where its coordinates are zero, m and without unit."""


def smooth_table(axes: object, values: object, functions: tuple[int, ...], what: str) -> SmoothTable:
    """The table of values at points.

    `axes`: one or two, equally spaced and rising, four points or more each; `values`: functions at the points, shape
    (n0, *functions) or (n0, n1, *functions); `functions`: nothing for one function, else how many there must be. Raises
    `ModelError`: points or values are not so.
    """
    if not isinstance(axes, (list, tuple)) and not (isinstance(axes, np.ndarray) and axes.ndim == 2):
        raise ModelError(f"The axes of {what} are {shown(axes)}; they must be one or two sequences of points.")
    if len(axes) not in (1, 2):
        raise ModelError(f"{capital(what)} has {len(axes)} axes; it must have one or two.")
    points = tuple(_axis(axis, what) for axis in axes)
    coefficients = array(values, (*(len(p) for p in points), *functions), f"the values of the table of {what}")
    coefficients = coefficients.reshape(*coefficients.shape[: len(points)], -1)
    for k in range(len(points)):
        coefficients = np.moveaxis(_control_points(np.moveaxis(coefficients, k, 0)), 0, k)
    return SmoothTable(points, coefficients if len(points) == 2 else coefficients[:, None, :])


def _axis(given: object, what: str) -> Array:
    points = array(given, (None,), f"one of the axes of the table of {what}")
    steps = np.diff(points)
    if len(points) < FEWEST or not np.all(steps > 0.0) or np.ptp(steps) > UNIFORM * steps.max():
        raise ModelError(
            f"One of the axes of the table of {what} has {len(points)} points; they must be {FEWEST} or more, "
            "rising and equally spaced."
        )
    return points


def _collocation(n: int) -> Array:
    """From n + 2 control points to n values, with a continuous third derivative next to both ends."""
    A = np.zeros((n + 2, n + 2))
    for i in range(n):
        A[i + 1, i : i + 3] = np.array([1.0, 4.0, 1.0]) / 6.0
    A[0, :5] = A[-1, -5:] = [1.0, -4.0, 6.0, -4.0, 1.0]
    return A


def _control_points(values: Array) -> Array:
    """Control points along the first axis through values there, two more than these."""
    none = np.zeros((1, values[0].size))
    coefficients = np.linalg.solve(_collocation(len(values)), np.vstack([none, values.reshape(len(values), -1), none]))
    return np.asarray(coefficients.reshape(len(values) + 2, *values.shape[1:]))


def pose_functions(base: Body, places: Array, rotations: Array) -> Array:
    """Functions of a tabled body, shape (..., 12), from places of its centre of mass and rotations on the base.

    `places`: in m, shape (..., 3); `rotations`: from the axes as drawn, shape (..., 3, 3).
    """
    axes = np.swapaxes(rotations, -1, -2).reshape(*rotations.shape[:-2], 9)
    return np.concatenate([places - base.com, axes], axis=-1)


def check_drawn(found: Array, drawn: Array, what: str) -> None:
    """Check that a table gives the drawn position where its coordinates are zero."""
    off = float(np.max(np.abs(found - drawn)))
    if off > DRAWN:
        raise ModelError(f"The table of {what} is off the drawing by {off:.3g} where its coordinates are zero.")


def checked_parameters(given: Any, what: str) -> tuple[Any, ...]:
    """One or two different coordinates."""
    coordinates = tuple(given) if isinstance(given, (list, tuple)) else (given,)
    if (
        is_number(given)
        or len(coordinates) not in (1, 2)
        or (len(coordinates) == 2 and coordinates[0] is coordinates[1])
    ):
        raise ModelError(f"The parameters of {what} are {shown(given)}; they must be one or two coordinates.")
    return coordinates
