"""Smooth table of a lookup-table body or number, with checks of its data."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import array, capital, is_number, shown
from mbs.common.errors import ModelError
from mbs.model.body import Body
from mbs.model.table_bodies import SmoothTable

Array = NDArray[np.float64]

MIN_POINTS = 4
"""Least number of points of a table along a coordinate."""
SPACING_TOLERANCE = 1e-9
"""Largest difference of two spacings, parts of the spacing."""
DRAWN_TOLERANCE = 1e-6
"""Largest difference between a table and the drawing where its coordinates are zero, m or without unit."""


def smooth_table(axes: object, values: object, functions: tuple[int, ...], subject: str) -> SmoothTable:
    """The smooth table through values at points.

    `axes`: one or two, each of four or more points, ascending and equally spaced; `values`: shape (n0, *functions) or
    (n0, n1, *functions); `functions`: shape of the values at a point. Raises `ModelError` if axes or values are not
    valid.
    """
    if not isinstance(axes, (list, tuple)) and not (isinstance(axes, np.ndarray) and axes.ndim == 2):
        raise ModelError(f"The axes of {subject} are {shown(axes)}; they must be one or two sequences of points.")
    if len(axes) not in (1, 2):
        raise ModelError(f"{capital(subject)} has {len(axes)} axes; it must have one or two.")
    points = tuple(_axis(axis, subject) for axis in axes)
    coefficients = array(values, (*(len(p) for p in points), *functions), f"the values of the table of {subject}")
    coefficients = coefficients.reshape(*coefficients.shape[: len(points)], -1)
    for k in range(len(points)):
        coefficients = np.moveaxis(_control_points(np.moveaxis(coefficients, k, 0)), 0, k)
    return SmoothTable(points, coefficients if len(points) == 2 else coefficients[:, None, :])


def _axis(axis: object, subject: str) -> Array:
    points = array(axis, (None,), f"one of the axes of the table of {subject}")
    steps = np.diff(points)
    if len(points) < MIN_POINTS or not np.all(steps > 0.0) or np.ptp(steps) > SPACING_TOLERANCE * steps.max():
        raise ModelError(
            f"One of the axes of the table of {subject} has {len(points)} points; they must be {MIN_POINTS} or more, "
            "rising and equally spaced."
        )
    return points


def _collocation(n: int) -> Array:
    """Matrix from n + 2 control points to n values, with a continuous third derivative next to both ends."""
    A = np.zeros((n + 2, n + 2))
    for i in range(n):
        A[i + 1, i : i + 3] = np.array([1.0, 4.0, 1.0]) / 6.0
    A[0, :5] = A[-1, -5:] = [1.0, -4.0, 6.0, -4.0, 1.0]
    return A


def _control_points(values: Array) -> Array:
    """Control points along the first axis for values there, two more than values."""
    zero_row = np.zeros((1, values[0].size))
    coefficients = np.linalg.solve(
        _collocation(len(values)), np.vstack([zero_row, values.reshape(len(values), -1), zero_row])
    )
    return np.asarray(coefficients.reshape(len(values) + 2, *values.shape[1:]))


def pose_functions(base: Body, places: Array, rotations: Array) -> Array:
    """Functions of a lookup-table body, shape (..., 12), of positions of its centre of mass and rotations on the base.

    `places`: m, shape (..., 3); `rotations`: rotation matrices from the drawn axes, shape (..., 3, 3).
    """
    axes = np.swapaxes(rotations, -1, -2).reshape(*rotations.shape[:-2], 9)
    return np.concatenate([places - base.com, axes], axis=-1)


def check_drawn(values: Array, drawn: Array, subject: str) -> None:
    """Raise `ModelError` unless a table has the drawn values where its coordinates are zero."""
    error = float(np.max(np.abs(values - drawn)))
    if error > DRAWN_TOLERANCE:
        raise ModelError(f"The table of {subject} is off the drawing by {error:.3g} where its coordinates are zero.")


def checked_parameters(parameters: Any, subject: str) -> tuple[Any, ...]:
    """One or two different coordinates."""
    coordinates = tuple(parameters) if isinstance(parameters, (list, tuple)) else (parameters,)
    if (
        is_number(parameters)
        or len(coordinates) not in (1, 2)
        or (len(coordinates) == 2 and coordinates[0] is coordinates[1])
    ):
        raise ModelError(f"The parameters of {subject} are {shown(parameters)}; they must be one or two coordinates.")
    return coordinates
