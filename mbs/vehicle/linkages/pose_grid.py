"""Poses of the parts of an axle over the compression of its springs and the travel of its rack, as tables need them.

The springs are the measure of travel, as their length leaves arms and wishbones no choice whatever the rack does: only
what is steered needs a table of two variables.
"""

from dataclasses import dataclass

import numpy as np

from mbs.simulation.evaluator import RANK_TOLERANCE
from mbs.vehicle.linkages.linkage import (
    CLOSE,
    LEFT_OVER,
    MOST_ITERATIONS,
    Array,
    Linkage,
    NotReachedError,
)

SPACING = 0.012, 0.006
"""Largest distance of points along compression and rack, m: poses are right to 2e-7 m and 3e-6 rad."""
MARGIN = 0.003
"""Of a table beyond stops and rack, m."""
FREE = 0.10
"""Compression of a table without stops, m."""
SAME = 1e-9
"""Difference of poses, m and without unit, that counts as none."""


@dataclass(frozen=True)
class PoseGrid:
    """Poses of the parts of an axle on a grid of travel and rack, with the chassis as drawn."""

    linkage: Linkage
    compression: Array
    rack: Array
    """`compression`, `rack`, shapes (n,) and (k,): points, m, positive in bump and to the left; one point of the rack
    where nothing steers."""
    coupled: bool
    """Whether each side depends on the compression of both springs: then the tables go over left and right."""
    q: Array
    """Shape (n, k, nq), or (n, n, nq) where coupled: coordinates of the linkage."""

    def full(self, start: int, size: int) -> Array:
        """Full coordinates of the linkage's model over the grid, shape (n, k, size)."""
        rows = [self.linkage.full(start + i) for i in range(size)]
        return np.stack([self.q @ row + constant for row, constant in rows], axis=-1)


def pose_grid(linkage: Linkage, rack_travel: float) -> PoseGrid:
    """Positions of an axle over the whole range of its springs and rack.

    `rack_travel`: to each side, m; 0 where the axle is not steered. Raises `NotReachedError`: the links end before the
    stops.
    """
    low, high = compression_range(linkage)
    compression = even_points(-low, high, SPACING[0])
    coupled = is_coupled(linkage)
    steered = linkage.has_rod and rack_travel > 0.0
    reach = rack_travel + MARGIN
    rack = even_points(-reach, reach, SPACING[1]) if steered else np.zeros(1)
    shape = (len(compression), len(compression) if coupled else len(rack))
    q = np.zeros((*shape, len(linkage.drawn.q)))
    along = _march(linkage, linkage.drawn.q, [((a, a), 0.0) for a in compression])
    for i, start in enumerate(along):
        second = (
            [((compression[i], b), 0.0) for b in compression] if coupled else [((compression[i],) * 2, u) for u in rack]
        )
        q[i] = _march(linkage, start, second, begin=i if coupled else int(np.argmin(np.abs(rack))))
    return PoseGrid(linkage, compression, rack, coupled, q)


def compression_range(linkage: Linkage) -> tuple[float, float]:
    """Largest extension and compression of a spring that a table must have, m: a little beyond its stops."""
    stops = linkage.data.stops
    if stops is None:
        return FREE, FREE
    return stops.rebound_gap + stops.rebound_travel + MARGIN, stops.bump_gap + stops.bump_travel + MARGIN


def even_points(low: float, high: float, spacing: float) -> Array:
    """Equally spaced from `low` to `high` or a little farther, with zero among them."""
    below = int(np.ceil(-low / spacing))
    step = -low / below
    return np.asarray(step * np.arange(-below, int(np.ceil(high / step - 1e-9)) + 1), float)


def _march(
    linkage: Linkage, start: Array, points: list[tuple[tuple[float, float], float]], begin: int | None = None
) -> Array:
    """Coordinates at places along a line, from the one nearest to the drawing (or `begin`) to both ends."""
    first = int(np.argmin([abs(c[0]) + abs(u) for c, u in points])) if begin is None else begin
    coordinates = np.zeros((len(points), len(start)))
    coordinates[first] = at_springs(linkage, start, *points[first])
    for direction, end in ((1, len(points)), (-1, -1)):
        for k in range(first + direction, end, direction):
            previous = coordinates[k - direction]
            guess = (
                2.0 * previous - coordinates[k - 2 * direction]
                if 0 <= k - 2 * direction < len(points) and k != first + direction
                else previous
            )
            coordinates[k] = at_springs(linkage, guess, *points[k])
    return coordinates


def at_springs(linkage: Linkage, start: Array, compression: tuple[float, float], rack: float) -> Array:
    """Coordinates (nq,) near a start at compressions of both springs and a travel of the rack.

    `compression`: of the left and the right spring from the drawing, m; `rack`: m. Raises `NotReachedError`: the links
    do not allow it.
    """
    q, still = start.copy(), np.zeros(len(start))
    lines = [linkage.linear(spring) for spring in linkage.springs]
    drawn = [float(np.linalg.norm(D @ linkage.drawn.q + d)) for D, d in lines]
    for _ in range(MOST_ITERATIONS):
        phi, jacobian, _ = linkage.constraints(q, still, rack)
        vectors = [D @ q + d for D, d in lines]
        lengths = np.array([np.linalg.norm(vector) for vector in vectors])
        rows = np.vstack(
            [jacobian, *(vector @ D / size for (D, _), vector, size in zip(lines, vectors, lengths, strict=True))]
        )
        residuals = np.concatenate([phi, lengths - drawn + compression])
        step = np.linalg.lstsq(rows, residuals, rcond=RANK_TOLERANCE)[0]
        q = q - step
        if not np.abs(step).max() < 0.5:
            break
        if np.abs(step).max() < CLOSE and np.abs(residuals).max() < LEFT_OVER:
            return np.asarray(q)
    raise NotReachedError(
        f"no position with springs compressed by {compression[0]:g} and {compression[1]:g} m and a rack at {rack:g} m"
    )


def is_coupled(linkage: Linkage) -> bool:
    """Whether the compression of the right spring moves the left wheel."""
    C, _ = linkage.centre(0)
    displaced = at_springs(linkage, linkage.drawn.q, (0.0, 0.01), 0.0)
    return bool(np.max(np.abs(C @ (displaced - linkage.drawn.q))) > SAME)


def depends_on_second(values: Array) -> bool:
    """Whether values over a grid, shape (n, k, ...), change along its second axis."""
    return bool(np.max(np.ptp(values, axis=1), initial=0.0) > SAME)
