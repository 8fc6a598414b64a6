"""Roads from OpenCRG files, version 1.2 of the format (ASAM OpenCRG), read by PyOpenCRG."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ali3.extras import missing_module
from ali3.reading import check_file
from ali3.words import one_line
from mbs.elements.road import GridRoad
from mbs.kernel.header.limits import ROAD_HIGHEST
from mbs.roads.road_header import RoadFileError
from mbs.roads.sampled_road import SampledRoad, Values, between, compared, points_of_box
from mbs.roads.steep_faces import RoadWarning

if TYPE_CHECKING:
    import pyopencrg

_LARGEST = 2**31  # bytes
_AT_ONCE = 2**18  # places
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
    apart = float(np.diff(crg.v).min())
    if spacing is None:
        along = crg.is_straight and abs(crg.phi_start) < _LEVEL
        spacing = (crg.u_inc, apart) if along else (min(crg.u_inc, apart),) * 2
    x, y = points_of_box(edges.min(axis=0), edges.max(axis=0), spacing, source)
    spacing = float(x[1] - x[0]), float(y[1] - y[0])
    heights = np.concatenate([_heights(crg, *places)[0] for places in _places(x, y)]).reshape(len(x), len(y))
    grid = GridRoad((float(x[0]), float(y[0])), spacing, heights)
    return compared(grid, _known(crg, *between(grid)), source)


def _heights(crg: pyopencrg.CrgRoad, x: Values, y: Values) -> tuple[Values, NDArray[np.bool_]]:
    """Heights at places, beside the road those of its border; and whether they lie on it."""
    u, v = crg.xy_to_uv(x, y)
    on_u, on_v = np.clip(u, crg.u[0], crg.u[-1]), np.clip(v, crg.v[0], crg.v[-1])
    return crg.uv_to_z(on_u, on_v), (on_u == u) & (on_v == v)


def _places(x: Values, y: Values) -> Iterator[tuple[Values, Values]]:
    """Places x and y of the points of a grid, some lines at once."""
    lines = max(_AT_ONCE // len(y), 1)
    for first in range(0, len(x), lines):
        part = x[first : first + lines]
        yield np.repeat(part, len(y)), np.tile(y, len(part))


def _known(crg: pyopencrg.CrgRoad, x: Values, y: Values) -> Iterator[tuple[Values, Values]]:
    """Places with heights of the road: those of a grid that lie on it, and its own points."""
    for places in _places(x, y):
        z, on = _heights(crg, *places)
        yield np.stack(places, -1), np.where(on, z, np.nan)
    z = crg.surface_z()
    for j, v in enumerate(crg.v):
        yield np.stack(crg.uv_to_xy(crg.u, np.full(crg.nu, v)), -1), z[:, j]


def _read(source: str) -> pyopencrg.CrgRoad:
    try:
        import pyopencrg

        with warnings.catch_warnings(record=True) as odd:
            warnings.simplefilter("always")
            crg = pyopencrg.read(source, apply_mods=True)
    except ModuleNotFoundError as error:
        raise RoadFileError(f"{source} cannot be read. {missing_module(error, 'roads')}") from None
    except Exception as error:  # what a reader raises on a damaged file has no common kind
        raise RoadFileError(f"{source} cannot be read as OpenCRG: {_first_fault(error, source)}.") from None
    for what in odd:
        warnings.warn(f"{source}: {_first_fault(what.message, source)}.", RoadWarning, stacklevel=4)
    return crg


def _first_fault(said: object, source: str) -> str:
    """The first fault of those that the reader lists, as one causes others, and how many more there are."""
    text, *faults = str(said).partition("\nTo open it anyway")[0].split("\n  - ")
    first = faults[0].removeprefix("(reading) ") if faults else text.removeprefix(f"{source}: ")
    more = f", the first of {len(faults)} faults" if len(faults) > 1 else ""
    return one_line(" ".join(first.split()).rstrip(".")) + more


def _checked(crg: pyopencrg.CrgRoad, source: str) -> None:
    """Refuses what a grid cannot have."""
    numbers = np.concatenate([np.ravel(a) for a in (crg.u, crg.v, crg.x, crg.y)])
    if min(crg.shape) < 2 or not np.all(np.abs(numbers) < 1e7):
        raise RoadFileError(f"{source} is no road: its points, {crg.nu} x {crg.nv}, do not lie within 10 000 km.")
    if np.any(high := np.abs(crg.surface_z()) > ROAD_HIGHEST):
        i, j = np.argwhere(high)[0].tolist()
        raise RoadFileError(
            f"{source} has a height of {crg.surface_z()[i, j]:.3g} m at u = {crg.u[i]:g} m, v = {crg.v[j]:g} m; it "
            f"must lie between {-ROAD_HIGHEST:g} and {ROAD_HIGHEST:g} m."
        )
    if np.any(bad := ~np.isfinite(crg.surface_z())):
        i, j = np.argwhere(bad)[0].tolist()
        raise RoadFileError(
            f"{source} has no height at u = {crg.u[i]:g} m, v = {crg.v[j]:g} m, one of {int(bad.sum())} such points "
            f"of the road; fill them, or let the modifier GRID_NAN_MODE of the file do it."
        )
