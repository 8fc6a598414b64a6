"""Roads from OpenCRG files, version 1.2 of the format (ASAM OpenCRG), read by PyOpenCRG."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial import cKDTree

from ali3.extras import missing_module
from ali3.message_text import one_line
from ali3.reading import check_file
from mbs.elements.road import GridRoad
from mbs.kernel.header.limits import ROAD_HIGHEST
from mbs.roads.road_header import RoadFileError
from mbs.roads.sampled_road import SampledRoad, Values, compared, grid_heights, points_of_box
from mbs.roads.steep_faces import RoadWarning

if TYPE_CHECKING:
    import pyopencrg

_LARGEST = 2**31  # bytes
_AT_ONCE = 2**18  # places
_BLOCK = 16  # points of the grid, from one of which the heights beside the road are known to the next
_FINER, _FINEST = 3.0, 12  # places of a comparison on the least spacing of the grid, and at most between two points
_MOST_COMPARED = 2**24  # places
_LOOKED_INTO = 64  # of each lot of places those at which the difference is largest
_ROUNDS = 4  # each by steps a fourth of those before
_LEVEL = 1e-9  # rad: a straight reference line with a smaller heading lies along x


def crg_road(path: str | os.PathLike[str], spacing: tuple[float, float] | None) -> SampledRoad:
    """A grid over the whole of a road in an OpenCRG file.

    The modifiers of the file hold, and where it has none those of the standard: heights that are missing are those
    beside them in their cross section, and the reference line begins at the origin along x. Beyond the border its
    heights go on.

    `path`: ``.crg``, in any of the forms of the standard; `spacing`: of the grid, m; by default that of the file where
    the road is straight along x, else the smaller of its two. Raises `RoadFileError`: it is no OpenCRG file, is
    damaged, has holes, or needs too many points. Warns `RoadWarning`: what the reader of the format found odd.
    """
    source = os.fspath(path)
    check_file(Path(path), _LARGEST, RoadFileError)
    crg = _read(source)
    _checked(crg, source)
    edges = np.concatenate([np.stack(crg.uv_to_xy(crg.u, np.full(crg.nu, v)), -1) for v in (crg.v[0], crg.v[-1])])
    v_spacing = float(np.diff(crg.v).min())
    if spacing is None:
        along_x = crg.is_straight and abs(crg.phi_start) < _LEVEL
        spacing = (crg.u_inc, v_spacing) if along_x else (min(crg.u_inc, v_spacing),) * 2
    x, y = points_of_box(edges.min(axis=0), edges.max(axis=0), spacing, source)
    spacing = float(x[1] - x[0]), float(y[1] - y[0])
    grid = GridRoad((float(x[0]), float(y[0])), spacing, _heights_about(crg, x, y))
    worst_positions = list[Values]()
    road = compared(grid, _surface_samples(crg, grid, worst_positions), source)
    largest, place = _largest(crg, grid, np.concatenate(worst_positions), road.largest, road.place)
    return replace(road, largest=largest, place=place)


def _heights(crg: pyopencrg.CrgRoad, x: Values, y: Values) -> Values:
    """Heights at points x, y, m; outside the road those of its border."""
    u, v = crg.xy_to_uv(x, y)
    return np.asarray(crg.uv_to_z(np.clip(u, crg.u[0], crg.u[-1]), np.clip(v, crg.v[0], crg.v[-1])))


def _heights_about(crg: pyopencrg.CrgRoad, x: Values, y: Values) -> Values:
    """Heights of an OpenCRG road on a grid: at each point near the road, elsewhere at every 16th and linear in between.

    Finding where a place lies along the road takes a microsecond, and most of the box of a long road is beside it.
    """
    lines = tuple(np.unique([*range(0, len(a), _BLOCK), len(a) - 1]) for a in (x, y))
    coarse_heights = _heights(crg, *(a.ravel() for a in np.meshgrid(x[lines[0]], y[lines[1]], indexing="ij")))
    coarse_heights = coarse_heights.reshape(len(lines[0]), len(lines[1]))
    heights = make_interp_spline(y[lines[1]], coarse_heights, 1, axis=1)(y)
    heights = make_interp_spline(x[lines[0]], heights, 1, axis=0)(x)
    size = _BLOCK * float(np.hypot(x[1] - x[0], y[1] - y[0]))
    centres = [a[k[:-1]] + 0.5 * (a[k[1:]] - a[k[:-1]]) for a, k in zip((x, y), lines, strict=True)]
    distances = cKDTree(np.column_stack([crg.x, crg.y])).query(np.stack(np.meshgrid(*centres, indexing="ij"), -1))[0]
    near = distances <= float(np.abs(crg.v[[0, -1]]).max()) + crg.u_inc + size
    for i in range(len(near)):
        rows = slice(lines[0][i], lines[0][i + 1] + 1)
        columns = np.flatnonzero(np.repeat(near[i], np.diff(lines[1])))
        columns = np.union1d(columns, columns + 1)
        if len(columns):
            positions = np.meshgrid(x[rows], y[columns], indexing="ij")
            heights[rows, columns] = _heights(crg, *(a.ravel() for a in positions)).reshape(positions[0].shape)
    return np.asarray(heights)


def _surface_samples(crg: pyopencrg.CrgRoad, road: GridRoad, worst: list[Values]) -> Iterator[tuple[Values, Values]]:
    """Places with heights of the road, evenly between its points and closer than those of the grid.

    `worst`: takes u, v of those at which the grid is farthest off, shape (k, 2).
    """
    intervals = [float(crg.u_inc), float(np.diff(crg.v).max())]
    subdivisions = [min(max(math.ceil(_FINER * d / min(road.spacing)), 3), _FINEST) for d in intervals]
    while math.prod(subdivisions) > 1 and crg.nu * crg.nv * math.prod(subdivisions) > _MOST_COMPARED:
        subdivisions[subdivisions.index(max(subdivisions))] -= 1
    u, v = (
        np.interp((np.arange((len(a) - 1) * n) + 0.5) / n, np.arange(len(a)), a)
        for a, n in zip((crg.u, crg.v), subdivisions, strict=True)
    )
    for u_batch in np.array_split(u, math.ceil(len(u) * len(v) / _AT_ONCE)):
        uv = np.stack([np.repeat(u_batch, len(v)), np.tile(v, len(u_batch))], -1)
        positions, z = _surface(crg, uv)
        deviations = np.abs(grid_heights(road, np.asarray(road.heights), positions) - z)
        worst.append(uv[np.argsort(deviations)[-_LOOKED_INTO:]])
        yield positions, z


def _largest(
    crg: pyopencrg.CrgRoad, road: GridRoad, at: Values, largest: float, place: tuple[float, float]
) -> tuple[float, tuple[float, float]]:
    """The largest difference of a grid near points u, v (k, 2) of a road, and its place, if it exceeds `largest`."""
    reach = np.array([crg.u_inc, float(np.diff(crg.v).max())]) / 2.0
    around = np.stack(np.meshgrid(*2 * [np.linspace(-1.0, 1.0, 9)]), -1).reshape(-1, 2)
    for _ in range(_ROUNDS):
        candidates = np.clip(at[:, None] + reach * around, (crg.u[0], crg.v[0]), (crg.u[-1], crg.v[-1]))
        positions, z = _surface(crg, candidates.reshape(-1, 2))
        deviations = np.abs(grid_heights(road, np.asarray(road.heights), positions) - z).reshape(candidates.shape[:2])
        peaks = deviations.argmax(axis=1)
        k = int(deviations.max(axis=1).argmax())
        if deviations[k, peaks[k]] > largest:
            x, y = positions[k * len(around) + int(peaks[k])].tolist()
            largest, place = float(deviations[k, peaks[k]]), (x, y)
        at, reach = candidates[np.arange(len(at)), peaks], reach / 4.0
    return largest, place


def _surface(crg: pyopencrg.CrgRoad, at: Values) -> tuple[Values, Values]:
    """x and y (n, 2) and heights (n,) at u and v (n, 2)."""
    return np.stack(crg.uv_to_xy(at[:, 0], at[:, 1]), -1), np.asarray(crg.uv_to_z(at[:, 0], at[:, 1]))


def _read(source: str) -> pyopencrg.CrgRoad:
    try:
        import pyopencrg

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            crg = pyopencrg.read(source, apply_mods=True)
    except ModuleNotFoundError as error:
        raise RoadFileError(f"{source} cannot be read. {missing_module(error, 'roads')}") from None
    except Exception as error:  # what a reader raises on a damaged file has no common kind
        raise RoadFileError(f"{source} cannot be read as OpenCRG: {_first_fault(error, source)}.") from None
    for warning in caught:
        warnings.warn(f"{source}: {_first_fault(warning.message, source)}.", RoadWarning, stacklevel=4)
    return crg


def _first_fault(message: object, source: str) -> str:
    """The first fault of those that the reader lists, as one causes others, and how many more there are."""
    text, *faults = str(message).partition("\nTo open it anyway")[0].split("\n  - ")
    first = faults[0].removeprefix("(reading) ") if faults else text.removeprefix(f"{source}: ")
    suffix = f", the first of {len(faults)} faults" if len(faults) > 1 else ""
    return one_line(" ".join(first.split()).rstrip(".")) + suffix


def _checked(crg: pyopencrg.CrgRoad, source: str) -> None:
    """Refuses what a grid cannot have."""
    numbers = np.concatenate([np.ravel(a) for a in (crg.u, crg.v, crg.x, crg.y)])
    if min(crg.shape) < 2 or not np.all(np.abs(numbers) < 1e7):
        raise RoadFileError(f"{source} is not a road: its points, {crg.nu} x {crg.nv}, do not lie within 10 000 km.")
    if np.any(too_high := np.abs(crg.surface_z()) > ROAD_HIGHEST):
        i, j = np.argwhere(too_high)[0].tolist()
        raise RoadFileError(
            f"{source} has a height of {crg.surface_z()[i, j]:.3g} m at u = {crg.u[i]:g} m, v = {crg.v[j]:g} m; it "
            f"must lie between {-ROAD_HIGHEST:g} and {ROAD_HIGHEST:g} m."
        )
    if np.any(holes := ~np.isfinite(crg.surface_z())):
        i, j = np.argwhere(holes)[0].tolist()
        raise RoadFileError(
            f"{source} has no height at u = {crg.u[i]:g} m, v = {crg.v[j]:g} m, one of {int(holes.sum())} such points "
            f"of the road; fill them, or let the modifier GRID_NAN_MODE of the file do it."
        )
