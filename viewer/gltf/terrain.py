"""The terrain of a world as triangles, by what it is made of."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.base64_numbers import decoded, octets
from viewer.gltf.materials import LOOKS, Look
from viewer.gltf.solids import Solid
from viewer.poses import Vectors

_MOST = 60_000  # cells
_FINEST = 0.25  # m


def earth_axes(up: Vectors) -> Vectors:
    """Axes x, y and up of a world, one a row."""
    return np.array([[1, 0, 0], [0, 1, 0] if abs(up[2]) > 0.5 else [0, 0, -1], up], float)


def terrain_solids(
    road: Mapping[str, Any], axes: Vectors, low: Vectors, high: Vectors
) -> tuple[list[tuple[Solid, Look]], float]:
    """Triangles of what lies in a rectangle, one solid a surface.

    `road`: of the scene, of the kind terrain; `axes`: x, y and up of the world, one a row, shape (3, 3); `low`, `high`:
    x and y of the corners of the rectangle, m, shape (2,).

    Returns
    -------
    solids : list of (Solid, Look)
        Of at most 60 000 cells together.
    error : float
        Largest height of a left-out point above or below the triangles, m.
    """
    cuts = [(patch, _cut(patch, low, high)) for patch in road["patches"]]
    inside = [(patch, cut) for patch, cut in cuts if cut is not None]
    spacing = _FINEST
    while sum(_cells(patch, cut, spacing) for patch, cut in inside) > _MOST:
        spacing *= 2.0
    raster = road["surface"]
    classes = octets(raster["classes"]).reshape(raster["shape"])
    made: dict[str, list[tuple[Vectors, NDArray[np.int64]]]] = {}
    error = 0.0
    for patch, (i, j) in inside:
        heights = decoded(patch["heights"], "f").reshape(patch["shape"]).astype(float)
        rows, columns = (_some(k, patch["spacing"][axis], spacing) for axis, k in enumerate((i, j)))
        kept = heights[np.ix_(rows, columns)]
        error = max(error, _error(heights[i[0] : i[1] + 1, j[0] : j[1] + 1], kept, rows - i[0], columns - j[0]))
        x, y = (patch["origin"][k] + patch["spacing"][k] * n for k, n in enumerate((rows, columns)))
        points = np.stack(np.broadcast_arrays(x[:, None], y[None, :], kept), axis=2).reshape(-1, 3)
        a = np.arange(len(x) - 1)[:, None] * len(y) + np.arange(len(y) - 1)
        middle = [0.5 * (way[1:] + way[:-1]) for way in (x, y)]
        cell = [_nearest(way, raster, k) for k, way in enumerate(middle)]
        kinds = classes[np.ix_(*cell)]
        for kind in np.unique(kinds):
            corner = a[kinds == kind]
            beside = corner + len(y)  # as the page cuts its cells
            triangles = np.vstack(
                [np.column_stack([corner, beside, corner + 1]), np.column_stack([beside, beside + 1, corner + 1])]
            )
            used, numbers = np.unique(triangles, return_inverse=True)
            name = str(raster["names"][kind])
            made.setdefault(name, []).append((points[used] @ axes, numbers.reshape(triangles.shape)))
    return [(_joined(parts), surface_look(name)) for name, parts in sorted(made.items())], error


def surface_look(name: str) -> Look:
    """The material of a surface."""
    colour = LOOKS["surfaces"].get(name, LOOKS["surfaces"]["asphalt"])
    return Look(name, (*colour, 1.0), 0.0, 0.25 if name in ("wet", "ice") else 0.92)


def _cut(patch: Mapping[str, Any], low: Vectors, high: Vectors) -> tuple[tuple[int, int], tuple[int, int]] | None:
    """First and last points along x and y in the rectangle."""
    ends = []
    for k in range(2):
        step, count = patch["spacing"][k], patch["shape"][k]
        first = int(np.floor((low[k] - patch["origin"][k]) / step))
        last = int(np.ceil((high[k] - patch["origin"][k]) / step))
        first, last = max(first, 0), min(last, count - 1)
        if first >= last:
            return None
        ends.append((first, last))
    return ends[0], ends[1]


def _some(ends: tuple[int, int], step: float, spacing: float) -> NDArray[np.int64]:
    every = max(1, round(spacing / step))
    return np.unique([*range(ends[0], ends[1], every), ends[1]])


def _cells(patch: Mapping[str, Any], cut: tuple[tuple[int, int], tuple[int, int]], spacing: float) -> int:
    rows, columns = (len(_some(ends, patch["spacing"][k], spacing)) - 1 for k, ends in enumerate(cut))
    return rows * columns


def _error(all_heights: Vectors, kept: Vectors, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> float:
    """Of heights that are linear along x, then along y, between those that are kept, m."""
    every = np.arange(all_heights.shape[0]), np.arange(all_heights.shape[1])
    along = np.stack([np.interp(every[0], rows, column) for column in kept.T], axis=1)
    both = np.stack([np.interp(every[1], columns, row) for row in along])
    return float(np.abs(both - all_heights).max())


def _nearest(places: Vectors, raster: Mapping[str, Any], k: int) -> NDArray[np.int64]:
    numbers = np.rint((places - raster["origin"][k]) / raster["spacing"][k]).astype(np.int64)
    return np.asarray(np.clip(numbers, 0, raster["shape"][k] - 1))


def _joined(parts: list[tuple[Vectors, NDArray[np.int64]]]) -> Solid:
    starts = np.cumsum([0, *(len(points) for points, _ in parts[:-1])])
    triangles = np.vstack([numbers + start for (_, numbers), start in zip(parts, starts, strict=True)])
    return Solid(np.vstack([points for points, _ in parts]), None, triangles)
