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
from mbs.roads.sampled_road import SampledRoad, Values, grid_heights, grid_over_box, measure_deviation
from mbs.roads.steep_faces import RoadWarning

if TYPE_CHECKING:
    import pyopencrg

MAX_BYTES = 2**31
BATCH_SIZE = 2**18  # points that are evaluated at once
COARSE_STEP = 16  # grid points between which heights beside the road are interpolated
SAMPLES_PER_SPACING = 3.0  # points of a comparison per smallest spacing of the grid
MAX_SUBDIVISIONS = 12  # points of a comparison between two points of the road
MAX_SAMPLES = 2**24  # points of a comparison
CANDIDATES = 64  # points of each batch with the largest differences, around which the maximum is sought
REFINEMENTS = 4  # each with a fourth of the steps before
HEADING_TOLERANCE = 1e-9  # rad: a straight reference line with a smaller heading lies along x
MAX_COORDINATE = 1e7  # m


def crg_road(path: str | os.PathLike[str], spacing: tuple[float, float] | None) -> SampledRoad:
    """Sample the heights of an OpenCRG road on a grid.

    The modifiers of the file are applied, by default as in the standard: missing heights are taken from the
    neighbours in the same cross section, and the reference line begins at the origin along x. Beyond the border the
    heights at the border continue.

    `path`: ``.crg``, in any form of the standard; `spacing`: spacing of the grid, m; by default the file's if the road
    is straight along x, otherwise the smaller of its two. Raises `RoadFileError` if the file is not OpenCRG, is
    damaged, has holes, or needs too many points. Warns `RoadWarning`: a warning of the reader of the format.
    """
    source = os.fspath(path)
    check_file(Path(path), MAX_BYTES, RoadFileError)
    crg = _read(source)
    _check_surface(crg, source)
    edges = np.concatenate([np.stack(crg.uv_to_xy(crg.u, np.full(crg.nu, v)), -1) for v in (crg.v[0], crg.v[-1])])
    v_spacing = float(np.diff(crg.v).min())
    if spacing is None:
        along_x = crg.is_straight and abs(crg.phi_start) < HEADING_TOLERANCE
        spacing = (crg.u_inc, v_spacing) if along_x else (min(crg.u_inc, v_spacing),) * 2
    x, y = grid_over_box(edges.min(axis=0), edges.max(axis=0), spacing, source)
    spacing = float(x[1] - x[0]), float(y[1] - y[0])
    grid = GridRoad((float(x[0]), float(y[0])), spacing, _heights_on_grid(crg, x, y))
    worst_positions = list[Values]()
    road = measure_deviation(grid, _surface_samples(crg, grid, worst_positions), source)
    largest, place = _largest_deviation(crg, grid, np.concatenate(worst_positions), road.largest, road.place)
    return replace(road, largest=largest, place=place)


def _heights(crg: pyopencrg.CrgRoad, x: Values, y: Values) -> Values:
    """Heights at points x, y, m; outside the road the heights at its border."""
    u, v = crg.xy_to_uv(x, y)
    return np.asarray(crg.uv_to_z(np.clip(u, crg.u[0], crg.u[-1]), np.clip(v, crg.v[0], crg.v[-1])))


def _heights_on_grid(crg: pyopencrg.CrgRoad, x: Values, y: Values) -> Values:
    """Heights of an OpenCRG road on a grid: at each point near the road, elsewhere at every 16th, linear in between.

    The station of a point takes a microsecond, and most of the bounding box of a long road lies beside it.
    """
    lines = tuple(np.unique([*range(0, len(a), COARSE_STEP), len(a) - 1]) for a in (x, y))
    coarse_heights = _heights(crg, *(a.ravel() for a in np.meshgrid(x[lines[0]], y[lines[1]], indexing="ij")))
    coarse_heights = coarse_heights.reshape(len(lines[0]), len(lines[1]))
    heights = make_interp_spline(y[lines[1]], coarse_heights, 1, axis=1)(y)
    heights = make_interp_spline(x[lines[0]], heights, 1, axis=0)(x)
    size = COARSE_STEP * float(np.hypot(x[1] - x[0], y[1] - y[0]))
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
    """Yield points x, y (n, 2) and heights (n,) of the road, m, evenly between its points and denser than the grid.

    `worst`: receives u and v, shape (k, 2), of the points with the largest deviations of the grid.
    """
    intervals = [float(crg.u_inc), float(np.diff(crg.v).max())]
    subdivisions = [
        min(max(math.ceil(SAMPLES_PER_SPACING * d / min(road.spacing)), 3), MAX_SUBDIVISIONS) for d in intervals
    ]
    while math.prod(subdivisions) > 1 and crg.nu * crg.nv * math.prod(subdivisions) > MAX_SAMPLES:
        subdivisions[subdivisions.index(max(subdivisions))] -= 1
    u, v = (
        np.interp((np.arange((len(a) - 1) * n) + 0.5) / n, np.arange(len(a)), a)
        for a, n in zip((crg.u, crg.v), subdivisions, strict=True)
    )
    for u_batch in np.array_split(u, math.ceil(len(u) * len(v) / BATCH_SIZE)):
        uv = np.stack([np.repeat(u_batch, len(v)), np.tile(v, len(u_batch))], -1)
        positions, z = _surface(crg, uv)
        deviations = np.abs(grid_heights(road, np.asarray(road.heights), positions) - z)
        worst.append(uv[np.argsort(deviations)[-CANDIDATES:]])
        yield positions, z


def _largest_deviation(
    crg: pyopencrg.CrgRoad, road: GridRoad, uv: Values, largest: float, place: tuple[float, float]
) -> tuple[float, tuple[float, float]]:
    """Largest deviation of a grid near points u, v (k, 2), and its x and y, m, or `largest` and `place`."""
    half_steps = np.array([crg.u_inc, float(np.diff(crg.v).max())]) / 2.0
    offsets = np.stack(np.meshgrid(*2 * [np.linspace(-1.0, 1.0, 9)]), -1).reshape(-1, 2)
    for _ in range(REFINEMENTS):
        candidates = np.clip(uv[:, None] + half_steps * offsets, (crg.u[0], crg.v[0]), (crg.u[-1], crg.v[-1]))
        positions, z = _surface(crg, candidates.reshape(-1, 2))
        deviations = np.abs(grid_heights(road, np.asarray(road.heights), positions) - z).reshape(candidates.shape[:2])
        peaks = deviations.argmax(axis=1)
        k = int(deviations.max(axis=1).argmax())
        if deviations[k, peaks[k]] > largest:
            x, y = positions[k * len(offsets) + int(peaks[k])].tolist()
            largest, place = float(deviations[k, peaks[k]]), (x, y)
        uv, half_steps = candidates[np.arange(len(uv)), peaks], half_steps / 4.0
    return largest, place


def _surface(crg: pyopencrg.CrgRoad, uv: Values) -> tuple[Values, Values]:
    """Points x, y (n, 2) and heights (n,) at u and v (n, 2), m."""
    return np.stack(crg.uv_to_xy(uv[:, 0], uv[:, 1]), -1), np.asarray(crg.uv_to_z(uv[:, 0], uv[:, 1]))


def _read(source: str) -> pyopencrg.CrgRoad:
    """Read an OpenCRG file with its modifiers. Raises `RoadFileError` if it cannot be read."""
    try:
        import pyopencrg

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            crg = pyopencrg.read(source, apply_mods=True)
    except ModuleNotFoundError as error:
        raise RoadFileError(f"{source} cannot be read. {missing_module(error, 'roads')}") from None
    except Exception as error:  # the errors of the reader on a damaged file have no common class
        raise RoadFileError(f"{source} cannot be read as OpenCRG: {_first_fault(error, source)}.") from None
    for warning in caught:
        warnings.warn(f"{source}: {_first_fault(warning.message, source)}.", RoadWarning, stacklevel=4)
    return crg


def _first_fault(message: object, source: str) -> str:
    """First of the faults that the reader lists, and their number: one fault causes others."""
    text, *faults = str(message).partition("\nTo open it anyway")[0].split("\n  - ")
    first = faults[0].removeprefix("(reading) ") if faults else text.removeprefix(f"{source}: ")
    suffix = f", the first of {len(faults)} faults" if len(faults) > 1 else ""
    return one_line(" ".join(first.split()).rstrip(".")) + suffix


def _check_surface(crg: pyopencrg.CrgRoad, source: str) -> None:
    """Raise `RoadFileError` if the road has no points, holes or heights beyond the limits."""
    numbers = np.concatenate([np.ravel(a) for a in (crg.u, crg.v, crg.x, crg.y)])
    if min(crg.shape) < 2 or not np.all(np.abs(numbers) < MAX_COORDINATE):
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
