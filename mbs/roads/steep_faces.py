"""Faces of a grid that are too steep for a wheel, which touches a grid at one point."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mbs.elements.road import GridRoad

WHEEL_RADIUS = 0.3
"""Radius of a car's wheel where no car is known, m."""
_LEAST = 0.005  # m: a tyre at rest is pressed in by several times that
_ROWS = 4096  # looked at in one piece


class RoadWarning(UserWarning):
    """A road that can be but is no road for a wheel; the message says where, and what would be right."""


class SteepFaces:
    """Looks for faces in the parts of a grid.

    Where a point lies so far below the mean of its neighbours that a wheel over it touches both of these first, the
    wheel meets the face beside it before it stands at its foot. The contact of a wheel with a grid is one point near
    the tangent plane under its centre: it finds the face when the centre is already beside it, deep in the road.

    Parameters
    ----------
    origin, spacing : (float, float)
        m, as in `GridRoad`.
    radius : float
        Of the wheel, m.
    """

    def __init__(self, origin: Sequence[float], spacing: Sequence[float], radius: float = WHEEL_RADIUS) -> None:
        self._origin, self._spacing, self._radius = origin, spacing, radius
        self._most = 1.0  # curvature times radius
        self._found: tuple[int, tuple[int, int], float] | None = None  # axis, point, how far below its neighbours twice

    def look(self, heights: NDArray[np.float64], first: tuple[int, int]) -> None:
        """A part of the heights, m, and the numbers of its first point along x and y."""
        for axis in range(2):
            if heights.shape[axis] < 3:
                continue
            depth = np.diff(heights, 2, axis=axis)
            i, j = np.unravel_index(int(depth.argmax()), depth.shape)
            deepest = float(depth[i, j])
            sharp = deepest / self._spacing[axis] ** 2 * self._radius
            if sharp > self._most and deepest > _LEAST:
                point = (first[0] + int(i) + (axis == 0), first[1] + int(j) + (axis == 1))
                self._most, self._found = sharp, (axis, point, deepest)

    def sentence(self, road: object) -> str:
        """What is wrong with `road`, empty if nothing is."""
        if self._found is None:
            return ""
        axis, point, depth = self._found
        x, y = (self._origin[k] + self._spacing[k] * point[k] for k in range(2))
        return (
            f"{road}: at x = {x:g} m, y = {y:g} m a face of {depth:.3g} m rises within {self._spacing[axis]:g} m; a "
            f"wheel of {self._radius:.3g} m radius touches it before it stands at its foot, which its contact with a "
            "grid does not find, so that the wheel loads will be far too large. A step is the road 'kerb'; in a grid "
            f"this face must rise over {math.sqrt(depth * self._radius):.2g} m or more, or its foot be round."
        )


def steep_face(road: GridRoad, name: object, radius: float = WHEEL_RADIUS) -> str:
    """A sentence on the face of a grid that is steepest for a wheel; empty if none is too steep.

    Parameters
    ----------
    road : GridRoad
    name : object
        How the sentence calls it.
    radius : float
        Of the wheel, m.
    """
    heights = np.asarray(road.heights, float)
    faces = SteepFaces(road.origin, road.spacing, radius)
    for k in range(0, max(len(heights) - 2, 1), _ROWS):
        faces.look(heights[k : k + _ROWS + 2], (k, 0))
    return faces.sentence(name)
