"""The header of a road file: `mbs/kernel/src/roads/road_file.h` has its layout."""

import os
import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import RoadType
from mbs.kernel.header.limits import (
    ROAD_FARTHEST,
    ROAD_FRICTION,
    ROAD_HIGHEST,
    ROAD_POINTS,
    ROAD_SHARED,
    ROAD_TILE,
    ROAD_VERSION,
)

MAGIC = b"ALI3ROAD"
HEADER = struct.Struct("<8sIIqiIqqii8dd")
REALS = 8
CHECKED_FROM = 16
TRAILER = struct.Struct("<qII")


class RoadFileError(ValueError):
    """A road that cannot be read or written: one sentence with the file and what would be right."""


@dataclass(frozen=True)
class Header:
    """Header of a road file."""

    kind: RoadType
    nx: int
    """Points of the grid along x, 0 without a grid."""
    ny: int
    """Points of the grid along y, 0 without a grid."""
    maps: int
    """1: heights, 2: heights and frictions."""
    real: tuple[float, ...]
    """Eight numbers, whose meaning depends on `kind`: `mbs/kernel/src/roads/road_file.h`."""
    contents: int = 0
    """CRC-32 of the checksums of all tiles, or of the table of them."""
    version: int = ROAD_VERSION
    """1: tiles in the order of the grid; 2: equal tiles are stored once."""
    written_bytes: int = 0
    """Size of a file of version 2."""

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
        """Bytes of the header in a file. Raises `RoadFileError` if a number is not valid."""
        fields = (self.file_bytes, int(self.kind), self.contents, self.nx, self.ny)
        tile = (ROAD_TILE, self.maps) if self.kind == RoadType.GRID else (0, 0)
        if fault := _fault(int(self.kind), self.nx, self.ny, *tile, self.real):
            raise RoadFileError(f"The road cannot be written: {fault}.")
        data = bytearray(HEADER.pack(MAGIC, self.version, 0, *fields, *tile, *self.real, 0.0))
        data[12:16] = struct.pack("<I", zlib.crc32(data[CHECKED_FROM:]))
        return bytes(data)


def read_header(file: BinaryIO, name: object) -> Header:
    """Read and check the header of an open road file. `name`: name of the file, for messages."""
    data = file.read(HEADER.size)
    if data[: len(MAGIC)] != MAGIC:
        raise RoadFileError(f"{name} is not a road file; ali3 road INPUT OUTPUT.road makes one.")
    if len(data) < HEADER.size:
        raise RoadFileError(f"{name} ends within its header.")
    _, version, crc, size, kind, contents, nx, ny, tile, maps, *real = HEADER.unpack(data)
    if version not in (ROAD_VERSION, ROAD_SHARED):
        raise RoadFileError(
            f"{name} is a road file of version {version}; versions {ROAD_VERSION} and {ROAD_SHARED} are read here."
        )
    if crc != zlib.crc32(data[CHECKED_FROM:]):
        raise RoadFileError(f"The header of {name} was altered or damaged.")
    if fault := _fault(kind, nx, ny, tile, maps, real):
        raise RoadFileError(f"{name} is not a readable road file: {fault}.")
    head = Header(RoadType(kind), nx, ny, maps, tuple(real[:REALS]), contents, version, size)
    file_size = file.seek(0, os.SEEK_END)
    if not size == head.file_bytes == file_size:
        raise RoadFileError(f"{name} has {file_size} bytes; its header says {size}: it was cut off or altered.")
    return head


def _fault(kind: int, nx: int, ny: int, tile: int, maps: int, real: Sequence[float]) -> str:
    """First fault of the numbers of a header, by the checks of the kernel; empty if there is none."""
    if not RoadType.PLANE <= kind <= RoadType.GRID:
        return f"{kind} is not a kind of road"
    if invalid := [x for x in real if not abs(x) <= ROAD_FARTHEST]:
        return f"a number in its header, {invalid[0]:g}, is not finite or beyond 1e8"
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


def check_grid(heights: NDArray[np.float64], frictions: NDArray[np.float64] | None, name: object) -> None:
    """Check the values of a grid. Raises `ModelError`, which names the first point outside the limits."""
    for quantity, values, low, high, unit in (
        ("height", heights, -ROAD_HIGHEST, ROAD_HIGHEST, " m"),
        ("friction", frictions, 0.0, ROAD_FRICTION, ""),
    ):
        if values is None:
            continue
        invalid = ~((values >= low) & (values <= high))
        if invalid.any():
            i, j = np.argwhere(invalid)[0].tolist()
            raise ModelError(
                f"The {quantity} of {name} at point ({i}, {j}) is {values[i, j]:g}{unit}; "
                f"it must lie between {low:g} and {high:g}{unit}."
            )
