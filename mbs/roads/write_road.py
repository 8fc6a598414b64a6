"""Writes road files."""

import os
import struct
import warnings
import zlib
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ali3.files import atomic_file
from mbs.common.checks import instance_of
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.header.enumerations import RoadType
from mbs.kernel.header.limits import ROAD_FRICTION, ROAD_TILE
from mbs.roads.road_header import REALS, Header, RoadFileError, check_grid
from mbs.roads.shared_tiles import SharedWriter
from mbs.roads.steep_faces import RoadWarning, steep_face


def write_road(
    road: PlaneRoad | KerbRoad | GridRoad,
    file: str | os.PathLike[str],
    *,
    shared: bool = False,
    tolerance: float = 0.0,
    name: object = None,
) -> None:
    """Write a road to a file that the kernel and FMUs read.

    Parameters
    ----------
    road : PlaneRoad, KerbRoad or GridRoad
        Its friction factor is multiplied into the frictions.
    file : path
        Written completely or not at all; an existing file is replaced.
    shared : bool
        Whether equal tiles of a grid are stored once.
    tolerance : float
        With `shared`: largest deviation of polynomials that are stored instead of the heights of tiles, m.
    name : object, optional
        Name of the road in messages; by default `file`.

    Raises
    ------
    ModelError
        A number of the road is outside its range, a height lies beyond 1e5 m or a friction outside 0 to 10.
    ali3.errors.FileError
        The file cannot be written.

    Warns
    -----
    RoadWarning
        A grid has a wall, a face that is higher than the radius of a wheel.
    """
    instance_of((PlaneRoad, KerbRoad, GridRoad), road, "What write_road writes", "a PlaneRoad, KerbRoad or GridRoad")
    name = file if name is None else name
    with atomic_file(file) as target, target.open("wb") as out:
        if shared and isinstance(road, GridRoad):
            _write_shared_tiles(road, out, name, tolerance)
        else:
            _write_content(road, out, name)
    if isinstance(road, GridRoad) and (warning := steep_face(road, name)):
        warnings.warn(warning, RoadWarning, stacklevel=2)


def _write_shared_tiles(road: GridRoad, out: BinaryIO, name: object, tolerance: float) -> None:
    """Write a grid with equal tiles stored once. `name`: name of the file, for messages; `tolerance`: as in
    `write_road`."""
    nx, ny, x0, y0, dx, dy, factor, *_ = road.real
    heights, frictions = np.asarray(road.heights, float), np.asarray(road.frictions, float) * factor
    check_grid(heights, np.atleast_2d(frictions), name)
    uniform = float(frictions) if frictions.ndim == 0 else None
    writer = SharedWriter(out, (int(nx), int(ny)), (x0, y0), (dx, dy), uniform, name, tolerance)
    for i in range(0, int(nx), ROAD_TILE):
        rows = slice(i, i + ROAD_TILE)
        writer.row(heights[rows], None if uniform is not None else frictions[rows])
    writer.finish()


def _write_content(road: PlaneRoad | KerbRoad | GridRoad, out: BinaryIO, name: object) -> None:
    """Write a road without shared tiles. `name`: name of the file, for messages."""
    if isinstance(road, GridRoad):
        _write_grid(road, out, name)
        return
    *real, factor = road.real
    real[-1] *= factor
    if real[-1] > ROAD_FRICTION:
        raise RoadFileError(f"The friction of {name} is {real[-1]:g}; it must lie between 0 and {ROAD_FRICTION:g}.")
    out.write(Header(road.type, 0, 0, 0, _padded_numbers(real)).to_bytes())


def _padded_numbers(real: list[float]) -> tuple[float, ...]:
    """Numbers of a header, filled up with zeros."""
    return (*real, *([0.0] * (REALS - len(real))))


def _write_grid(road: GridRoad, out: BinaryIO, name: object) -> None:
    """Write a grid with a checksum of each tile. `name`: name of the file, for messages."""
    nx, ny, x0, y0, dx, dy, factor, *_ = road.real
    heights = np.asarray(road.heights, float)
    frictions = np.asarray(road.frictions, float) * factor
    check_grid(heights, np.atleast_2d(frictions), name)
    uniform = frictions.ndim == 0
    header = Header(
        RoadType.GRID,
        int(nx),
        int(ny),
        1 if uniform else 2,
        _padded_numbers([x0, y0, dx, dy, float(frictions) if uniform else 1.0]),
    )
    out.write(header.to_bytes())
    maps = [heights] if uniform else [heights, frictions]
    tiles_y, checksums = header.tiles[1], []
    for number in range(header.tiles[0] * tiles_y):
        i, j = (number // tiles_y) * ROAD_TILE, (number % tiles_y) * ROAD_TILE
        data = b"".join(_tile_bytes(values[i : i + ROAD_TILE, j : j + ROAD_TILE]) for values in maps)
        data += struct.pack("<qI", number, 0)
        checksums.append(zlib.crc32(data))
        out.write(data + struct.pack("<I", checksums[-1]))
    out.seek(0)
    contents = zlib.crc32(struct.pack(f"<{len(checksums)}I", *checksums))
    out.write(Header(header.kind, header.nx, header.ny, header.maps, header.real, contents).to_bytes())


def _tile_bytes(values: NDArray[np.float64]) -> bytes:
    """Bytes of a tile of at most `ROAD_TILE` rows and columns, filled up with zeros."""
    tile = np.zeros((ROAD_TILE, ROAD_TILE), "<f8")
    tile[: values.shape[0], : values.shape[1]] = values
    return tile.tobytes()
