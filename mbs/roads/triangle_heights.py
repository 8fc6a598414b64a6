"""Heights of triangles at the points of a grid."""

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]
_AT_ONCE = 2**21  # points in lines of triangles
_UPRIGHT = 1e-12  # of a triangle's size: twice its area seen from above, up to which it is seen as a line
_NEAR = 1e-9  # of a spacing: a point this near to an edge lies on it


def triangle_heights(corners: Values, x: Values, y: Values) -> tuple[Values, Values]:
    """Lowest and highest height of triangles at the points of a regular grid; NaN where there is none.

    Each line of points along y that crosses a triangle is cut by its edges (scan conversion). Upright triangles are
    seen as lines and left out.

    `corners`: m, shape (n, 3, 3); `x`, `y`: of the points, regular, m, shapes (nx,) and (ny,). Returns `lowest` and
    `highest`, shape (nx, ny), m.
    """
    lowest, highest = np.full((len(x), len(y)), np.inf), np.full((len(x), len(y)), -np.inf)
    steps = np.array([a[1] - a[0] if len(a) > 1 else 1.0 for a in (x, y)])
    # In units of points; corners in ascending order of x.
    p = corners.copy()
    p[..., :2] = (p[..., :2] - [x[0], y[0]]) / steps
    p = np.take_along_axis(p, np.argsort(p[:, :, 0], axis=1)[:, :, None], axis=1)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (p[:, k].T for k in range(3))
    doubled_areas = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    visible = np.abs(doubled_areas) > _UPRIGHT * (1.0 + np.abs(p[..., :2]).max(axis=(1, 2)))
    first = np.ceil(np.maximum(ax - _NEAR, 0.0)).astype(np.int64)
    lines = np.where(visible, np.floor(np.minimum(cx + _NEAR, len(x) - 1.0)).astype(np.int64) - first + 1, 0).clip(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope_x = ((bz - az) * (cy - ay) - (cz - az) * (by - ay)) / doubled_areas
        slope_y = ((cz - az) * (bx - ax) - (bz - az) * (cx - ax)) / doubled_areas
    for begin, end in _pieces(lines):
        k = np.repeat(np.arange(begin, end), lines[begin:end])
        i = first[k] + _counted(lines[begin:end])
        long_share = _part(i, ax[k], cx[k])
        long_edge = ay[k] + long_share * (cy[k] - ay[k])
        on_first_edge = i <= bx[k]
        short_edges = np.where(
            on_first_edge,
            ay[k] + _part(i, ax[k], bx[k], 1.0) * (by[k] - ay[k]),
            by[k] + _part(i, bx[k], cx[k]) * (cy[k] - by[k]),
        )
        j = np.ceil(np.maximum(np.minimum(long_edge, short_edges) - _NEAR, 0.0)).astype(np.int64)
        last = np.floor(np.minimum(np.maximum(long_edge, short_edges) + _NEAR, len(y) - 1.0)).astype(np.int64)
        points = (last - j + 1).clip(0)
        for start, stop in _pieces(points):
            n = points[start:stop]
            triangle, row = np.repeat(k[start:stop], n), np.repeat(i[start:stop], n)
            column = np.repeat(j[start:stop], n) + _counted(n)
            z = az[triangle] + slope_x[triangle] * (row - ax[triangle]) + slope_y[triangle] * (column - ay[triangle])
            np.minimum.at(lowest, (row, column), z)
            np.maximum.at(highest, (row, column), z)
    missing = np.isinf(highest)
    lowest[missing] = highest[missing] = np.nan
    return lowest, highest


def _part(at: Values, begin: Values, end: Values, empty: float = 0.0) -> Values:
    """Relative position of a value between two others, 0 to 1; `empty` where these are equal."""
    length = end - begin
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(length > 0.0, ((at - begin) / length).clip(0.0, 1.0), empty))


def _counted(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """0 to n - 1 for each n of the counts, one after another."""
    return np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)


def _pieces(counts: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Ranges of entries whose counts sum to at most _AT_ONCE, or one entry that has more."""
    pieces, begin, total = [], 0, np.concatenate([[0], np.cumsum(counts)])
    while begin < len(counts):
        end = max(int(np.searchsorted(total, total[begin] + _AT_ONCE, side="right")) - 1, begin + 1)
        pieces.append((begin, end))
        begin = end
    return pieces
