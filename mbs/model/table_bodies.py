"""Lookup-table bodies and numbers: their motion is a table of one or two coordinates.

They add no coordinates and no rows to the equations: position on the base and axes, Y p(a, b) and Y R(a, b) with the
axes Y of the base, are dependent coordinates, which forces and sensors use like coordinates of other bodies. The
functions are uniform cubic B-splines through the points of the table; their error is of fourth order in the spacing.
Outside the table they continue along their tangents; a step that starts there is refused.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import AffineVector
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate, CoordinateInfo

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SmoothTable:
    """Functions of one or two variables as uniform cubic B-splines."""

    axes: tuple[Array, ...]
    """Points along each variable."""
    coefficients: Array
    """Shape (n0 + 2, n1 + 2, k), or (n0 + 2, 1, k) of one variable: control points of the cubic B-splines."""

    def value(self, *point: float) -> Array:
        """The functions at a point of the variables, shape (k,)."""
        values = self.coefficients
        for axis, x in zip(self.axes, point, strict=True):
            values = np.tensordot(_weights(axis, x), values, axes=1)
        return np.asarray(values if len(self.axes) == 2 else values[0])


def _weights(axis: Array, x: float) -> Array:
    """Weights of the control points of a cubic B-spline at `x`; outside the table it continues along its tangent."""
    step = float(axis[1] - axis[0])
    position = (x - axis[0]) / step
    clamped = min(max(position, 0.0), len(axis) - 1.0)
    cell = min(int(clamped), len(axis) - 2)
    s, excess = clamped - cell, position - clamped
    r = 1.0 - s
    value = np.array([r**3, 4.0 - 6.0 * s**2 + 3.0 * s**3, 4.0 - 6.0 * r**2 + 3.0 * r**3, s**3]) / 6.0
    slope = np.array([-0.5 * r * r, s * (1.5 * s - 2.0), r * (2.0 - 1.5 * r), 0.5 * s * s])
    weights = np.zeros(len(axis) + 2)
    weights[cell : cell + 4] = value + excess * slope
    return weights


class LookupTableBody(Body):
    """A rigid body that a table places on another (`Model.tabled_body`); it takes forces and sensors, no joints."""

    is_lookup_table = True
    outputs: tuple[str, ...] = ()
    """Sensors of the wheel in drawings: of its centre, of the quaternion of the body, of its angle."""
    base: Body
    """Body on which the table places it."""
    parameters: tuple[Coordinate, ...]
    """Variables of its table."""
    table: SmoothTable
    """Along the axes of the base: p, from the `com` of the base to its `com`, then the columns of R, its axes."""

    def coordinates(self) -> list[CoordinateInfo]:
        """Dependent coordinates of the body: of the position, then of each axis."""
        return [CoordinateInfo(c.name, "tabled", c.component, c.reference) for c in super().coordinates()]

    def reference(self) -> Array:
        """Dependent coordinates in the reference configuration, shape (12,)."""
        return np.concatenate([self.com - self.base.com, np.eye(3).ravel()])

    def _affine_point(self, local: tuple[float, ...], origin: float) -> AffineVector:
        offset = super()._affine_point(local, origin)
        return self.base.point(self.base.com) + offset if origin else offset


@dataclass(frozen=True)
class LookupTableNumber(Coordinate):
    """A number that is a function of one or two coordinates; made by `Model.tabled_number`."""

    parameters: tuple[Coordinate, ...]
    table: SmoothTable
