"""Faces of a grid that are walls for a wheel."""

import numpy as np

from mbs.elements.road import GridRoad

WHEEL_RADIUS = 0.3
"""Radius of a car's wheel if no car is known, m."""
MAX_SLOPE = 2.0
"""Rise over run of a face that a wheel climbs, 63 degrees."""
BLOCK_ROWS = 4096  # grid rows that are evaluated at once


class RoadWarning(UserWarning):
    """A road that a wheel cannot follow; the message says where, and what would be right."""


def steep_face(road: GridRoad, name: object, radius: float = WHEEL_RADIUS) -> str:
    """Sentence on the highest wall of a grid for a wheel; empty if there is none.

    The contact of a wheel with a grid is the deepest point of the surface in the disc, whose centre must lie above the
    surface. At a face that rises by more than the radius over half the radius, or from one point to the next, the
    centre can get below the surface.

    `name`: name of the road in the sentence; `radius`: radius of the wheel, m.
    """
    heights = np.asarray(road.heights, float)
    highest, index, run = radius, None, 0.0
    for axis in range(2):
        points = min(max(1, int(radius / MAX_SLOPE / road.spacing[axis])), heights.shape[axis] - 1)
        for first in range(0, max(len(heights) - points, 1), BLOCK_ROWS):
            block = heights[first : first + BLOCK_ROWS + points]
            rise = (
                np.abs(block[points:] - block[:-points])
                if axis == 0
                else np.abs(block[:, points:] - block[:, :-points])
            )
            if rise.size and rise.max() > highest:
                highest = float(rise.max())
                i, j = (int(k) for k in np.unravel_index(int(rise.argmax()), rise.shape))
                index, run = (first + i, j), points * road.spacing[axis]
    if index is None:
        return ""
    x, y = (road.origin[k] + road.spacing[k] * index[k] for k in range(2))
    return (
        f"{name}: at x = {x:g} m, y = {y:g} m a face of {highest:.3g} m rises within {run:g} m (points "
        f"{road.spacing[0]:g} by {road.spacing[1]:g} m apart); a wheel of {radius:.3g} m radius does not climb it, and "
        "a run in which the centre of a wheel gets below the surface there is refused. A step that is driven over is "
        "lower than the radius."
    )
