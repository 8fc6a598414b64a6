"""A grid of heights sampled from another surface, and its deviation from that surface."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from ctypes import POINTER, c_double
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mbs.elements.road import GridRoad
from mbs.kernel.binding.library import load_library
from mbs.roads.road_header import RoadFileError
from mbs.roads.steep_faces import RoadWarning

Values = NDArray[np.float64]
MAX_POINTS = 2**24
"""Largest number of points of a grid: 134 MB of heights."""
WARNING_DEVIATION = 0.01
"""Deviation above which a warning is given, m."""
CELL_POINT = 0.382, 0.618
"""Point of each cell at which heights are compared, relative to its sides: edges of a design rarely lie there."""


@dataclass(frozen=True)
class SampledRoad(GridRoad):
    """A grid sampled from another surface, with its deviation from that surface."""

    source: str = ""
    """Name of the other surface, for messages."""
    largest: float = 0.0
    """Largest deviation, m."""
    rms: float = 0.0
    """Root mean square of the deviation, m."""
    place: tuple[float, float] = (0.0, 0.0)
    """x and y of the largest deviation, m."""

    @property
    def sentence(self) -> str:
        """Deviation from the source, such as "differs from a.obj by 3 mm at most, ..."."""
        return (
            f"differs from {self.source} by {1000.0 * self.largest:.3g} mm at most, at x = {self.place[0]:.6g} m, "
            f"y = {self.place[1]:.6g} m, and by {1000.0 * self.rms:.3g} mm (root mean square)"
        )

    def moved_to(self, origin: Sequence[float]) -> SampledRoad:
        """Copy with the first grid point at `origin`, x and y, m."""
        x, y = (self.place[k] + origin[k] - self.origin[k] for k in range(2))
        return replace(self, origin=origin, place=(x, y))


def grid_over_box(
    low: Values, high: Values, spacing: tuple[float, float], source: str, hint: str = ""
) -> tuple[Values, Values]:
    """Coordinates x (nx,) and y (ny,), m, of a grid over a box, at most `spacing` apart.

    `low`, `high`: x and y of the corners of the box, m; `source`: name of the surface, for messages; `hint`: further
    sentence of the message. Raises `RoadFileError` if the grid has too many points.
    """
    sides = high - low
    # a side that is a multiple of the spacing but for round-off needs no further point
    counts = np.maximum(np.ceil(sides / spacing - 1e-6), 1.0) + 1.0
    if not counts.prod() <= MAX_POINTS:  # also refuses NaN
        coarser = max(spacing) * float(np.sqrt(counts.prod() / MAX_POINTS)) * 1.05  # 5 % margin
        raise RoadFileError(
            f"{source} is {sides[0]:.4g} by {sides[1]:.4g} m, which at a spacing of {spacing[0]:g} by {spacing[1]:g} m "
            f"is a grid of {counts.prod():.3g} points; {MAX_POINTS} are read at most. A spacing of {coarser:.2g} m by "
            f"{coarser:.2g} m fits.{hint}"
        )
    x, y = (low[k] + sides[k] / (counts[k] - 1.0) * np.arange(int(counts[k])) for k in range(2))
    return x, y


def cell_points(road: GridRoad) -> tuple[Values, Values]:
    """Coordinates x (nx - 1,) and y (ny - 1,), m, of one point in each cell, at which heights are compared."""
    shape = np.shape(road.heights)
    x, y = (road.origin[k] + road.spacing[k] * (np.arange(shape[k] - 1) + CELL_POINT[k]) for k in range(2))
    return x, y


def measure_deviation(road: GridRoad, samples: Iterable[tuple[Values, Values]], source: str) -> SampledRoad:
    """Make a road with its deviation from the surface that it was sampled from.

    `samples`: x and y (n, 2) and heights (n,) of the surface, m; NaN if it has none.
    """
    heights = np.ascontiguousarray(road.heights, np.float64)
    largest = 0.0
    place = float(road.origin[0]), float(road.origin[1])
    sum_of_squares = 0.0
    count = 0
    for positions, surface_heights in samples:
        deviations = np.abs(grid_heights(road, heights, positions) - surface_heights)
        deviations = np.where(np.isnan(deviations), 0.0, deviations)
        k = int(deviations.argmax())
        if deviations[k] > largest:
            largest = float(deviations[k])
            place = float(positions[k, 0]), float(positions[k, 1])
        sum_of_squares += float(deviations @ deviations)
        count += int(np.isfinite(surface_heights).sum())
    return SampledRoad(
        road.origin,
        road.spacing,
        heights,
        road.frictions,
        source=source,
        largest=largest,
        rms=float(np.sqrt(sum_of_squares / max(count, 1))),
        place=place,
    )


def warn_of_deviation(road: SampledRoad) -> None:
    """Warn of a deviation above `WARNING_DEVIATION`."""
    if road.largest > WARNING_DEVIATION:
        step = " by ".join(f"{h:.4g}" for h in road.spacing)
        warnings.warn(
            f"The grid with points {step} m apart {road.sentence}; a smaller spacing follows it more closely.",
            RoadWarning,
            stacklevel=4,  # the caller of `read_road`
        )


def grid_heights(road: GridRoad, heights: Values, positions: Values) -> Values:
    """Heights (n,) of the surface of a grid, m, as the kernel computes them.

    `heights`: heights of the road, contiguous, (nx, ny), m; `positions`: x and y, (n, 2), m.
    """
    interpolated_heights = np.empty(len(positions))
    grid = np.array((*road.origin, *road.spacing), np.float64)
    points = np.ascontiguousarray(positions, np.float64)
    grid_pointer, heights_pointer, points_pointer, result_pointer = (
        a.ctypes.data_as(POINTER(c_double)) for a in (grid, heights, points, interpolated_heights)
    )
    load_library().ali3_grid_heights(
        *heights.shape, grid_pointer, heights_pointer, len(positions), points_pointer, result_pointer
    )
    return interpolated_heights
