"""Poses of the parts of an axle on a grid of spring compression and rack travel, for tables.

The variable is the compression of the springs, as it determines the position of arms and wishbones for any travel of
the rack: only the poses of steered parts are tables of two variables.
"""

from dataclasses import dataclass

import numpy as np

from mbs.vehicle.linkages.linkage import Array, Linkage

SPACING = 0.012, 0.006
"""Largest spacing of points along compression and rack, m: poses are accurate to 2e-7 m and 3e-6 rad."""
MARGIN = 0.003
"""Length of a table beyond the stops and the travel of the rack, m."""
DEFAULT_COMPRESSION = 0.10
"""Largest compression and extension in a table of a spring without stops, m."""
POSE_TOLERANCE = 1e-9
"""Largest difference of equal poses, m and 1."""


@dataclass(frozen=True)
class PoseGrid:
    """Poses of the parts of an axle on a grid of travel and rack, with the chassis as drawn."""

    linkage: Linkage
    compression: Array
    """Points of the springs, m, positive in bump, shape (n,)."""
    rack: Array
    """Points of the rack, m, positive to the left, shape (k,); k is 1 for an axle that is not steered."""
    coupled: bool
    """Whether each side depends on the compressions of both springs, which are then the variables of the tables."""
    q: Array
    """Coordinates of the linkage, shape (n, k, nq), or (n, n, nq) if coupled."""

    def full(self, start: int, size: int) -> Array:
        """Full coordinates over the grid, computed from `start`, shape (n, k, size)."""
        rows = [self.linkage.full(start + i) for i in range(size)]
        return np.stack([self.q @ row + constant for row, constant in rows], axis=-1)


def pose_grid(linkage: Linkage, rack_travel: float) -> PoseGrid:
    """Compute the positions of an axle over the range of its springs and its rack.

    `rack_travel`: travel to each side, m; 0 if the axle is not steered. Raises `NotReachedError` if the links cannot
    reach the stops.
    """
    low, high = compression_range(linkage)
    compression = even_points(-low, high, SPACING[0])
    coupled = is_coupled(linkage)
    steered = linkage.has_rod and rack_travel > 0.0
    reach = rack_travel + MARGIN
    rack = even_points(-reach, reach, SPACING[1]) if steered else np.zeros(1)
    shape = (len(compression), len(compression) if coupled else len(rack))
    q = np.zeros((*shape, len(linkage.drawn.q)))
    coordinates = _follow(linkage, linkage.drawn.q, [((a, a), 0.0) for a in compression])
    for i, start in enumerate(coordinates):
        second = (
            [((compression[i], b), 0.0) for b in compression] if coupled else [((compression[i],) * 2, u) for u in rack]
        )
        q[i] = _follow(linkage, start, second, first=i if coupled else int(np.argmin(np.abs(rack))))
    return PoseGrid(linkage, compression, rack, coupled, q)


def compression_range(linkage: Linkage) -> tuple[float, float]:
    """Largest extension and compression of a spring in a table, m: `MARGIN` beyond its stops."""
    stops = linkage.data.stops
    if stops is None:
        return DEFAULT_COMPRESSION, DEFAULT_COMPRESSION
    return stops.rebound_gap + stops.rebound_travel + MARGIN, stops.bump_gap + stops.bump_travel + MARGIN


def even_points(low: float, high: float, spacing: float) -> Array:
    """Equidistant points from `low` to `high` or beyond by less than a step, with zero among them."""
    below = int(np.ceil(-low / spacing))
    step = -low / below
    return np.asarray(step * np.arange(-below, int(np.ceil(high / step - 1e-9)) + 1), float)


def _follow(
    linkage: Linkage, start: Array, points: list[tuple[tuple[float, float], float]], first: int | None = None
) -> Array:
    """Coordinates at points along a line, continued from the one nearest to the drawing, or `first`, to both ends."""
    if first is None:
        first = int(np.argmin([abs(c[0]) + abs(u) for c, u in points]))
    coordinates = np.zeros((len(points), len(start)))
    coordinates[first] = linkage.at_springs(start, *points[first])
    for direction, end in ((1, len(points)), (-1, -1)):
        for k in range(first + direction, end, direction):
            previous = coordinates[k - direction]
            guess = (
                2.0 * previous - coordinates[k - 2 * direction]
                if 0 <= k - 2 * direction < len(points) and k != first + direction
                else previous
            )
            coordinates[k] = linkage.at_springs(guess, *points[k])
    return coordinates


def is_coupled(linkage: Linkage) -> bool:
    """Whether the compression of the right spring moves the left wheel."""
    C, _ = linkage.centre(0)
    displaced = linkage.at_springs(linkage.drawn.q, (0.0, 0.01), 0.0)
    return bool(np.max(np.abs(C @ (displaced - linkage.drawn.q))) > POSE_TOLERANCE)


def depends_on_second(values: Array) -> bool:
    """Whether values over a grid, shape (n, k, ...), vary along the second axis."""
    return bool(np.max(np.ptp(values, axis=1), initial=0.0) > POSE_TOLERANCE)
