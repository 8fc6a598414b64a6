"""The road file in Python: `mbs/kernel/src/roads/road_file.h` has its layout."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from mbs.checks import instance_of
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.errors import ModelError
from mbs.kernel.header import (
    ROAD_FARTHEST,
    ROAD_FRICTION,
    ROAD_HIGHEST,
    ROAD_POINTS,
    ROAD_SHARED,
    ROAD_TILE,
    ROAD_VERSION,
    RoadType,
)

MAGIC = b"ALI3ROAD"
HEADER = struct.Struct("<8sIIqiIqqii8dd")
REALS = 8
CHECKED_FROM = 16
TRAILER = struct.Struct("<qII")
TEXTS = (".csv", ".txt")
"""Suffixes of tables that the kernel reads by itself."""
MOST_IN_MEMORY = 10**8
"""Points of a grid that is read as a whole."""


class RoadFileError(ValueError):
    """A road that cannot be read or written: one sentence with the file and what would be right."""


@dataclass(frozen=True)
class RoadFile:
    """A road of a file that ``ali3 road`` or `write_road` made, of which the kernel keeps in memory what is near.

    A table with coordinates (``.csv``, ``.txt``) is taken too; it is kept as a whole.

    Parameters
    ----------
    path : path
        The file; `Model.road` takes it relative to the current folder.
    road : PlaneRoad, KerbRoad or GridRoad
        The road in the file's place while the equilibrium of a model is sought, and where the file is taken away. Its
        friction factor multiplies the frictions of the file.
    """

    path: str | os.PathLike[str]
    road: PlaneRoad | KerbRoad | GridRoad = field(default_factory=PlaneRoad)

    def __post_init__(self) -> None:
        instance_of((str, os.PathLike), self.path, "The path of a RoadFile", "a path")
        instance_of((PlaneRoad, KerbRoad, GridRoad), self.road, "The road of a RoadFile", "a road of mbs.elements")

    @property
    def header(self) -> Header:
        """What the beginning of the file says.

        Raises
        ------
        RoadFileError
            The file is not there, no road file, or damaged.
        """
        with _opened(self.path) as file:
            return read_header(file, self.path)

    def check(self) -> None:
        """Refuse what is not there or no road: the beginning of a road file is looked at, a table as a whole.

        Raises
        ------
        RoadFileError
            With the file and what is wrong with it.
        """
        if Path(self.path).suffix.lower() in TEXTS:
            from mbs.roads.grid_files import read_grid

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
        with _opened(self.path) as file:
            head = read_header(file, self.path)
            if head.kind == RoadType.PLANE:
                return PlaneRoad(*head.real[:4])
            if head.kind == RoadType.KERB:
                position, lower, step, side, friction = head.real[:5]
                return KerbRoad(position, step, lower, "before" if side > 0.0 else "after", friction)
            if head.nx * head.ny > MOST_IN_MEMORY:
                raise RoadFileError(f"{self.path} has {head.nx} x {head.ny} points, too many to be read as a whole.")
            heights, frictions = _read_grid(file, head, self.path)
        return GridRoad(head.real[0:2], head.real[2:4], heights, head.real[4] if frictions is None else frictions)


@dataclass(frozen=True)
class Header:
    """What the beginning of a road file says.

    Parameters
    ----------
    kind : RoadType
    nx, ny : int
        Points of the grid, 0 without one.
    maps : int
        1: heights, 2: heights and frictions.
    real : tuple of float
        Eight numbers of the road.
    contents : int
        CRC-32 of the checksums of all tiles, or of the table of them.
    version : int
        1: each tile in its place; 2: equal tiles once.
    written_bytes : int
        Size of the file, of version 2.
    """

    kind: RoadType
    nx: int
    ny: int
    maps: int
    real: tuple[float, ...]
    contents: int = 0
    version: int = ROAD_VERSION
    written_bytes: int = 0

    @property
    def tiles(self) -> tuple[int, int]:
        """Number of tiles in x and y."""
        return -(-self.nx // ROAD_TILE), -(-self.ny // ROAD_TILE)

    @property
    def tile_bytes(self) -> int:
        """Size of a tile."""
        return self.maps * ROAD_TILE * ROAD_TILE * 8 + TRAILER.size

    @property
    def file_bytes(self) -> int:
        """Size of the file."""
        if self.version == ROAD_SHARED:
            return self.written_bytes
        return HEADER.size + self.tiles[0] * self.tiles[1] * self.tile_bytes

    def to_bytes(self) -> bytes:
        """As it stands in the file."""
        fields = (self.file_bytes, int(self.kind), self.contents, self.nx, self.ny)
        tile = (ROAD_TILE, self.maps) if self.kind == RoadType.GRID else (0, 0)
        data = bytearray(HEADER.pack(MAGIC, self.version, 0, *fields, *tile, *self.real, 0.0))
        data[12:16] = struct.pack("<I", zlib.crc32(data[CHECKED_FROM:]))
        return bytes(data)


def _opened(path: str | os.PathLike[str]) -> BinaryIO:
    place = Path(path)
    try:
        if not place.is_file():  # a named pipe would wait for its writer
            words = "it is no regular file" if place.exists() else "there is no such file"
            raise RoadFileError(f"The road {path} cannot be read: {words}.")
        return place.open("rb")
    except (OSError, ValueError) as error:
        if isinstance(error, RoadFileError):
            raise
        raise RoadFileError(f"The road {path} cannot be read: {getattr(error, 'strerror', None) or error}.") from None


def read_header(file: BinaryIO, name: object) -> Header:
    """The checked header of an open road file."""
    data = file.read(HEADER.size)
    if data[: len(MAGIC)] != MAGIC:
        raise RoadFileError(f"{name} is no road file; ali3 road INPUT OUTPUT.road makes one.")
    if len(data) < HEADER.size:
        raise RoadFileError(f"{name} ends within its header.")
    _, version, crc, size, kind, contents, nx, ny, tile, maps, *real = HEADER.unpack(data)
    if version not in (ROAD_VERSION, ROAD_SHARED):
        raise RoadFileError(
            f"{name} is a road file of version {version}; versions {ROAD_VERSION} and {ROAD_SHARED} are read here."
        )
    if crc != zlib.crc32(data[CHECKED_FROM:]):
        raise RoadFileError(f"The header of {name} was altered or damaged.")
    if problem := _problem(kind, nx, ny, tile, maps, real):
        raise RoadFileError(f"{name} is no road file that can be read: {problem}.")
    head = Header(RoadType(kind), nx, ny, maps, tuple(real[:REALS]), contents, version, size)
    found = file.seek(0, os.SEEK_END)
    if not size == head.file_bytes == found:
        raise RoadFileError(f"{name} has {found} bytes; its header says {size}: it was cut off or altered.")
    return head


def _problem(kind: int, nx: int, ny: int, tile: int, maps: int, real: Sequence[float]) -> str:
    """What is wrong with the numbers of a header, as the kernel judges them; empty if nothing is."""
    if kind not in list(RoadType):
        return f"{kind} is no kind of road"
    if not all(abs(x) <= ROAD_FARTHEST for x in real):
        return "a number in its header is not finite or beyond 1e8"
    if not 0.0 <= real[3 if kind == RoadType.PLANE else 4] <= ROAD_FRICTION:
        return f"its friction lies outside 0 to {ROAD_FRICTION:g}"
    if kind == RoadType.KERB and not (real[2] > 0.0 and real[3] in (-1.0, 1.0)):
        return "the step of its kerb is not positive or its side neither 1 nor -1"
    if kind != RoadType.GRID:
        return "" if (nx, ny, maps) == (0, 0, 0) else "a plane or kerb has no grid"
    if tile != ROAD_TILE or maps not in (1, 2):
        return "its tiles have another form"
    if min(nx, ny) < 2 or max(nx, ny) > 2**30 or nx * ny > ROAD_POINTS:
        return f"its grid has {nx} x {ny} points"
    if not (real[2] > 0.0 and real[3] > 0.0):
        return "the spacing of its grid is not positive"
    return "" if max(nx * real[2], ny * real[3]) <= ROAD_FARTHEST else "its grid reaches farther than 1e8 m"


def _read_grid(file: BinaryIO, head: Header, name: object) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    tiles_x, tiles_y = head.tiles
    values = np.empty((head.maps, tiles_x * ROAD_TILE, tiles_y * ROAD_TILE))
    checksums = []
    if head.version == ROAD_SHARED:
        from mbs.roads.shared_tiles import read_shared

        for number, block in read_shared(file, head, name):
            i, j = (number // tiles_y) * ROAD_TILE, (number % tiles_y) * ROAD_TILE
            values[:, i : i + ROAD_TILE, j : j + ROAD_TILE] = block
        maps = values[:, : head.nx, : head.ny]
        return maps[0].copy(), maps[1].copy() if head.maps == 2 else None
    file.seek(HEADER.size)
    for number in range(tiles_x * tiles_y):
        data = file.read(head.tile_bytes)
        written, _, crc = TRAILER.unpack(data[-TRAILER.size :])
        if written != number or crc != zlib.crc32(data[:-4]):
            raise RoadFileError(f"Part {number} of the road {name} was altered or damaged.")
        i, j = (number // tiles_y) * ROAD_TILE, (number % tiles_y) * ROAD_TILE
        block = np.frombuffer(data, "<f8", head.maps * ROAD_TILE * ROAD_TILE).reshape(head.maps, ROAD_TILE, ROAD_TILE)
        values[:, i : i + ROAD_TILE, j : j + ROAD_TILE] = block
        checksums.append(crc)
    if head.contents != zlib.crc32(struct.pack(f"<{len(checksums)}I", *checksums)):
        raise RoadFileError(f"Parts of the road {name} belong to another file.")
    maps = values[:, : head.nx, : head.ny]
    return maps[0].copy(), maps[1].copy() if head.maps == 2 else None


def check_grid(heights: NDArray[np.float64], frictions: NDArray[np.float64] | None, name: object) -> None:
    """One sentence for values that no road has, with the first place."""
    for what, values, low, high, unit in (
        ("height", heights, -ROAD_HIGHEST, ROAD_HIGHEST, " m"),
        ("friction", frictions, 0.0, ROAD_FRICTION, ""),
    ):
        if values is None:
            continue
        bad = ~((values >= low) & (values <= high))
        if bad.any():
            i, j = np.argwhere(bad)[0].tolist()
            raise ModelError(
                f"The {what} of {name} at point ({i}, {j}) is {values[i, j]:g}{unit}; "
                f"it must lie between {low:g} and {high:g}{unit}."
            )
