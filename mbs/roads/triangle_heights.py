"""Heights of triangles at the points of a grid."""

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]
BATCH_SIZE = 2**21  # grid points that are evaluated at once
AREA_TOLERANCE = 1e-12  # twice the projected area / size of a triangle, up to which it is upright
EDGE_TOLERANCE = 1e-9  # distance of a point from an edge in units of the spacing, up to which it lies on it


def triangle_heights(corners: Values, x: Values, y: Values) -> tuple[Values, Values]:
    """Lowest and highest height of triangles at the points of a regular grid; NaN if there is none.

    Each line of points along y that crosses a triangle is cut by its edges (scan conversion). Upright triangles are
    omitted.

    `corners`: m, shape (n, 3, 3); `x`, `y`: equidistant coordinates of the points, m, shapes (nx,) and (ny,). Returns
    `lowest` and `highest`, shape (nx, ny), m.
    """
    lowest, highest = np.full((len(x), len(y)), np.inf), np.full((len(x), len(y)), -np.inf)
    steps = np.array([a[1] - a[0] if len(a) > 1 else 1.0 for a in (x, y)])
    # coordinates in units of the spacing; corners in ascending order of x
    p = corners.copy()
    p[..., :2] = (p[..., :2] - [x[0], y[0]]) / steps
    p = np.take_along_axis(p, np.argsort(p[:, :, 0], axis=1)[:, :, None], axis=1)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (p[:, k].T for k in range(3))
    doubled_areas = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    visible = np.abs(doubled_areas) > AREA_TOLERANCE * (1.0 + np.abs(p[..., :2]).max(axis=(1, 2)))
    first = np.ceil(np.maximum(ax - EDGE_TOLERANCE, 0.0)).astype(np.int64)
    lines = np.where(
        visible, np.floor(np.minimum(cx + EDGE_TOLERANCE, len(x) - 1.0)).astype(np.int64) - first + 1, 0
    ).clip(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope_x = ((bz - az) * (cy - ay) - (cz - az) * (by - ay)) / doubled_areas
        slope_y = ((cz - az) * (bx - ax) - (bz - az) * (cx - ax)) / doubled_areas
    for begin, end in _batches(lines):
        k = np.repeat(np.arange(begin, end), lines[begin:end])
        i = first[k] + _indices_in_groups(lines[begin:end])
        long_fraction = _relative_position(i, ax[k], cx[k])
        long_edge = ay[k] + long_fraction * (cy[k] - ay[k])
        on_first_edge = i <= bx[k]
        short_edges = np.where(
            on_first_edge,
            ay[k] + _relative_position(i, ax[k], bx[k], 1.0) * (by[k] - ay[k]),
            by[k] + _relative_position(i, bx[k], cx[k]) * (cy[k] - by[k]),
        )
        j = np.ceil(np.maximum(np.minimum(long_edge, short_edges) - EDGE_TOLERANCE, 0.0)).astype(np.int64)
        last = np.floor(np.minimum(np.maximum(long_edge, short_edges) + EDGE_TOLERANCE, len(y) - 1.0)).astype(np.int64)
        points = (last - j + 1).clip(0)
        for start, stop in _batches(points):
            n = points[start:stop]
            triangle, row = np.repeat(k[start:stop], n), np.repeat(i[start:stop], n)
            column = np.repeat(j[start:stop], n) + _indices_in_groups(n)
            z = az[triangle] + slope_x[triangle] * (row - ax[triangle]) + slope_y[triangle] * (column - ay[triangle])
            np.minimum.at(lowest, (row, column), z)
            np.maximum.at(highest, (row, column), z)
    missing = np.isinf(highest)
    lowest[missing] = highest[missing] = np.nan
    return lowest, highest


def _relative_position(value: Values, begin: Values, end: Values, default: float = 0.0) -> Values:
    """Position of a value between two others, 0 to 1; `default` where these are equal."""
    length = end - begin
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(length > 0.0, ((value - begin) / length).clip(0.0, 1.0), default))


def _indices_in_groups(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Indices 0 to n - 1 for each n of the counts, one group after another."""
    return np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)


def _batches(counts: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Ranges of entries whose counts sum to at most `BATCH_SIZE`; an entry with more is a range of its own."""
    batches, begin, total = [], 0, np.concatenate([[0], np.cumsum(counts)])
    while begin < len(counts):
        end = max(int(np.searchsorted(total, total[begin] + BATCH_SIZE, side="right")) - 1, begin + 1)
        batches.append((begin, end))
        begin = end
    return batches
