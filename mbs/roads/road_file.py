"""Road files in Python: reference to a file for a model, and its complete content."""

import os
import struct
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ali3.reading import LARGEST_IN_PARTS, open_file
from mbs.common.checks import instance_of
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad, RoadOfFile
from mbs.kernel.header.enumerations import RoadType
from mbs.kernel.header.limits import ROAD_SHARED, ROAD_TILE
from mbs.roads.grid_files import read_grid
from mbs.roads.road_header import HEADER, TRAILER, Header, RoadFileError, read_header
from mbs.roads.shared_tiles import read_shared

TABLE_SUFFIXES = (".csv", ".txt")
"""Of tables that the kernel reads."""
MAX_POINTS = 10**8
"""Largest number of points of a grid that is read as a whole."""


@dataclass(frozen=True)
class RoadFile(RoadOfFile):
    """A road file that ``ali3 road`` or `write_road` made; the kernel holds only the tiles near the wheels in memory.

    A table with coordinates (``.csv``, ``.txt``) is accepted too and held as a whole.
    """

    path: str | os.PathLike[str]
    """The file; `Model.road` takes it relative to the current folder."""
    road: PlaneRoad | KerbRoad | GridRoad = field(default_factory=PlaneRoad)
    """The road in the file's place while the equilibrium of a model is sought, and if the file is taken away. Its
    friction factor multiplies the frictions of the file."""

    def __post_init__(self) -> None:
        instance_of((str, os.PathLike), self.path, "The path of a RoadFile", "a path")
        instance_of((PlaneRoad, KerbRoad, GridRoad), self.road, "The road of a RoadFile", "a road of mbs.elements")

    @property
    def header(self) -> Header:
        """Header of the file: type, grid and frictions.

        Raises
        ------
        RoadFileError
            The file is missing, not a road file, or damaged.
        """
        with _open(self.path) as file:
            return read_header(file, self.path)

    def check(self) -> None:
        """Refuse a missing file or one that is not a road: of a road file the header is checked, of a table everything.

        Raises
        ------
        RoadFileError
            With the file and what is wrong with it.
        """
        if Path(self.path).suffix.lower() in TABLE_SUFFIXES:
            read_grid(self.path, None, "heights")
        else:
            _ = self.header

    def read(self) -> PlaneRoad | KerbRoad | GridRoad:
        """The whole road in memory, every part checked.

        Raises
        ------
        RoadFileError
            As `header`; or a part is damaged, or the grid has more than 1e8 points.
        """
        with _open(self.path) as file:
            head = read_header(file, self.path)
            if head.kind == RoadType.PLANE:
                return PlaneRoad(*head.real[:4])
            if head.kind == RoadType.KERB:
                position, lower, step, side, friction = head.real[:5]
                return KerbRoad(position, step, lower, "before" if side > 0.0 else "after", friction)
            if head.nx * head.ny > MAX_POINTS:
                raise RoadFileError(f"{self.path} has {head.nx} x {head.ny} points, too many to be read as a whole.")
            heights, frictions = _read_grid(file, head, self.path)
        return GridRoad(head.real[0:2], head.real[2:4], heights, head.real[4] if frictions is None else frictions)


def _open(path: str | os.PathLike[str]) -> BinaryIO:
    return open_file(path, LARGEST_IN_PARTS, RoadFileError, f"The road {path}")


def _read_grid(file: BinaryIO, head: Header, name: object) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Heights and frictions of a grid (nx, ny) from the tiles of a file; `name`: name of the file, for messages."""
    tiles_x, tiles_y = head.tiles
    values = np.empty((head.maps, tiles_x * ROAD_TILE, tiles_y * ROAD_TILE))
    checksums = []
    if head.version == ROAD_SHARED:
        for number, block in read_shared(file, head, name):
            i, j = (number // tiles_y) * ROAD_TILE, (number % tiles_y) * ROAD_TILE
            values[:, i : i + ROAD_TILE, j : j + ROAD_TILE] = block
        return _grid_points(values, head)
    file.seek(HEADER.size)
    for number in range(tiles_x * tiles_y):
        data = file.read(head.tile_bytes)
        tile_number, _, crc = TRAILER.unpack(data[-TRAILER.size :])
        if tile_number != number or crc != zlib.crc32(data[:-4]):
            raise RoadFileError(f"Part {number} of the road {name} was altered or damaged.")
        i, j = (number // tiles_y) * ROAD_TILE, (number % tiles_y) * ROAD_TILE
        block = np.frombuffer(data, "<f8", head.maps * ROAD_TILE * ROAD_TILE).reshape(head.maps, ROAD_TILE, ROAD_TILE)
        values[:, i : i + ROAD_TILE, j : j + ROAD_TILE] = block
        checksums.append(crc)
    if head.contents != zlib.crc32(struct.pack(f"<{len(checksums)}I", *checksums)):
        raise RoadFileError(f"Parts of the road {name} belong to another file.")
    return _grid_points(values, head)


def _grid_points(values: NDArray[np.float64], head: Header) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Heights and frictions (nx, ny) of a grid, cut from whole tiles; no frictions if the file has one."""
    heights, *frictions = values[:, : head.nx, : head.ny]
    return heights.copy(), frictions[0].copy() if frictions else None
