"""Tiles of a road file of version 2, equal ones stored once: `mbs/kernel/src/roads/shared_tile.h` has their layout."""

import struct
import zlib
from collections.abc import Iterable
from functools import cache
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.enumerations import RoadType
from mbs.kernel.header.limits import ROAD_SHARED, ROAD_TILE
from mbs.roads.road_header import HEADER, Header, RoadFileError, check_grid

ENTRY = struct.Struct("<qiIII")
RECORD = struct.Struct("<iiii")
MAX_COEFFICIENTS = 8
ORDERS = (2, 3, 4, 6, 8)
"""Numbers of polynomial coefficients in x and y that are tried."""
MAX_FRICTIONS = 255
TOLERANCE = 5e-6
"""Largest deviation of the polynomial of a tile from its heights, m: 1 N for a tyre of 200 N/mm."""

Float = NDArray[np.float64]
_POINTS = ROAD_TILE * ROAD_TILE
TILE_COORDINATES: Float = (np.arange(ROAD_TILE) - 0.5 * (ROAD_TILE - 1)) / (ROAD_TILE // 2)
"""Coordinates of the points of a tile, -1 to 1, shape (32,)."""


class SharedWriter:
    """Writes the tiles of a grid row by row.

    Parameters
    ----------
    out : file
        Empty, open for reading and writing.
    shape : (int, int)
        Numbers of points in x and y.
    origin, spacing : (float, float)
        First point and spacing, m.
    friction : float or None
        Of all points; None: each tile has its own.
    name : object
        Name of the file in errors.
    tolerance : float
        Of the polynomials, m; 0: heights are not approximated.
    """

    def __init__(
        self,
        out: BinaryIO,
        shape: tuple[int, int],
        origin: tuple[float, float],
        spacing: tuple[float, float],
        friction: float | None,
        name: object,
        tolerance: float = 0.0,
    ) -> None:
        self.out, self.name, self.tolerance = out, name, tolerance
        real = (*origin, *spacing, 1.0 if friction is None else friction, 0.0, 0.0, 0.0)
        self.head = Header(RoadType.GRID, *shape, 2 if friction is None else 1, real, 0, ROAD_SHARED, 0)
        self.places: dict[bytes, int] = {}
        self.entries = bytearray()
        self.count = 0
        rows, columns = self.head.tiles
        self.end = HEADER.size + rows * columns * ENTRY.size
        out.write(b"\0" * self.end)

    def row(self, heights: Float, frictions: Float | None) -> None:
        """Add the next row of tiles: 32 points in x and all in y.

        `heights`: m, shape (32 or fewer in the last row, ny); `frictions`: likewise, None if the file has one friction.
        """
        check_grid(heights, frictions, self.name)
        z = _pad(heights)
        mu = None if frictions is None else _pad(frictions)
        tiles = z.shape[1] // ROAD_TILE
        blocks = z.reshape(ROAD_TILE, tiles, ROAD_TILE).transpose(1, 0, 2)
        for k, form in enumerate(fit_polynomials(blocks, TILE_COORDINATES, self.tolerance)):
            block_frictions = None if mu is None else np.ascontiguousarray(mu[:, k * ROAD_TILE : (k + 1) * ROAD_TILE])
            self.tile(np.ascontiguousarray(blocks[k]) if form is None else form, block_frictions)

    def tile(self, heights: Float, frictions: Float | None) -> None:
        """Add the next tile, with checked values.

        `heights`: m, shape (32, 32), or coefficients, at most (8, 8); `frictions`: shape (32, 32) or (1, 1), None if
        the file has one friction.
        """
        self._add(record_bytes(heights, frictions))

    def _add(self, record: bytes) -> None:
        """Append a tile; write its record unless an equal one has been written."""
        offset = self.places.get(record)
        if offset is None:
            offset = self.places[record] = self.end
            self.out.write(record)
            self.end += len(record)
        entry = ENTRY.pack(offset, len(record), zlib.crc32(record), 0, 0)[:-4]
        self.entries += entry + struct.pack("<I", zlib.crc32(struct.pack("<q", self.count) + entry))
        self.count += 1

    def finish(self) -> None:
        """Write the table and the header, after the last row."""
        rows, columns = self.head.tiles
        if self.count != rows * columns:
            raise RoadFileError(f"{self.name} has {self.count} tiles of {rows * columns}.")
        h = self.head
        head = Header(h.kind, h.nx, h.ny, h.maps, h.real, zlib.crc32(self.entries), ROAD_SHARED, self.end)
        self.out.seek(0)
        self.out.write(head.to_bytes() + self.entries)


def _pad(values: Float) -> Float:
    """Pad a grid to whole tiles with the values at its border."""
    padding = [-n % ROAD_TILE for n in values.shape]
    return np.pad(values, [(0, padding[0]), (0, padding[1])], mode="edge") if any(padding) else values


def polynomial_values(c: Float) -> Float:
    """Heights of the points of a tile (32, 32), m, with sums in the order of the kernel, so with the same bits.

    `c`: polynomial coefficients, shape (rows, columns).
    """
    z = np.zeros((ROAD_TILE, ROAD_TILE))
    for a in range(c.shape[0] - 1, -1, -1):
        row = np.zeros(ROAD_TILE)
        for b in range(c.shape[1] - 1, -1, -1):
            row = row * TILE_COORDINATES + c[a, b]
        z = z * TILE_COORDINATES[:, None] + row[None, :]
    return z


def fit_polynomials(blocks: Float, coordinates: Float, tolerance: float) -> list[Float | None]:
    """Coefficients of the smallest polynomial of each tile within the tolerance; None if there is none.

    `blocks`: heights, m, shape (tiles, n, n); `coordinates`: coordinates of their points in a tile, -1 to 1, shape
    (n,); `tolerance`: m; 0: only level tiles have polynomials.
    """
    forms: list[Float | None] = [None] * len(blocks)
    first_heights = blocks[:, :1, :1]
    level = (blocks == first_heights).all(axis=(1, 2))
    for k in np.flatnonzero(level):
        forms[k] = np.ascontiguousarray(first_heights[k])
    remaining = np.flatnonzero(~level)
    for order in ORDERS if tolerance > 0.0 else ():
        if len(remaining) == 0:
            break
        power, fit = _power_and_fit(tuple(coordinates.tolist()), order)
        c = fit @ blocks[remaining] @ fit.T
        deviations = np.abs(power @ c @ power.T - blocks[remaining]).max(axis=(1, 2))
        accepted = deviations <= tolerance
        for k, coefficients in zip(remaining[accepted], c[accepted], strict=True):
            forms[k] = np.ascontiguousarray(coefficients)
        remaining = remaining[~accepted]
    return forms


@cache
def _power_and_fit(coordinates: tuple[float, ...], order: int) -> tuple[Float, Float]:
    """Powers of the coordinates (n, order), and the matrix of the least-squares coefficients (order, n)."""
    power = np.vander(coordinates, order, increasing=True)
    return power, np.linalg.pinv(power)


def record_bytes(heights: Float, frictions: Float | None) -> bytes:
    """Bytes of a tile in a file. `heights`, `frictions`: as in `SharedWriter.tile`."""
    friction_count, friction_bytes = 0, b""
    if frictions is not None:
        friction_count, friction_bytes = _friction_bytes(frictions)
    return RECORD.pack(*heights.shape, friction_count, 0) + heights.astype("<f8").tobytes() + friction_bytes


def _friction_bytes(frictions: Float) -> tuple[int, bytes]:
    """Number of different frictions in a tile, and their bytes."""
    first = frictions.flat[0]
    if (frictions == first).all():
        return 1, struct.pack("<d", first)
    values, indices = np.unique(frictions, return_inverse=True)
    if len(values) > MAX_FRICTIONS:
        return _POINTS, frictions.astype("<f8").tobytes()
    return len(values), values.astype("<f8").tobytes() + indices.astype(np.uint8).tobytes()


def read_shared(file: BinaryIO, head: Header, name: object) -> Iterable[tuple[int, Float]]:
    """Yield the number and the values (maps, 32, 32) of each tile: heights, m, then frictions if there are two maps.

    `file`: the open file; `name`: its name, for messages. Raises `RoadFileError` if a tile is damaged.
    """
    file.seek(HEADER.size)
    count = head.tiles[0] * head.tiles[1]
    table = file.read(count * ENTRY.size)
    if zlib.crc32(table) != head.contents:
        raise RoadFileError(f"The table of parts of the road {name} was altered or damaged.")
    tiles: dict[int, Float] = {}
    for number, (offset, size, crc, _, _) in enumerate(ENTRY.iter_unpack(table)):
        if offset not in tiles:
            in_file = 0 < offset <= head.file_bytes - size and 0 < size <= head.file_bytes
            file.seek(offset if in_file else 0)
            record = file.read(size) if in_file else b""
            if len(record) != size or crc != zlib.crc32(record):
                raise RoadFileError(f"Part {number} of the road {name} was altered or damaged.")
            tiles = tiles if len(tiles) < 4096 else {}
            tiles[offset] = _tile_values(record, head.maps, f"Part {number} of the road {name}")
        yield number, tiles[offset]


def _tile_values(record: bytes, maps: int, name: str) -> Float:
    """Heights and frictions of a tile from its record. Raises `RoadFileError` if the record is damaged."""
    try:
        rows, columns, friction_count, zero = RECORD.unpack(record[: RECORD.size])
        reals = np.frombuffer(record, "<f8", rows * columns + friction_count, RECORD.size)
        heights = reals[: rows * columns].reshape(rows, columns)
        tail = record[RECORD.size + reals.nbytes :]
        is_polynomial = min(rows, columns) >= 1 and max(rows, columns) <= MAX_COEFFICIENTS
        if friction_count > MAX_FRICTIONS and friction_count != _POINTS:
            raise ValueError
        if (
            zero
            or (maps == 2) != (friction_count > 0)
            or not (is_polynomial or (rows, columns) == (ROAD_TILE, ROAD_TILE))
        ):
            raise ValueError
        values = [polynomial_values(heights) if is_polynomial else heights]
        if maps == 2:
            mu = reals[rows * columns :]
            indices = (
                np.frombuffer(tail, np.uint8, _POINTS)
                if 1 < friction_count <= MAX_FRICTIONS
                else np.zeros(_POINTS, np.uint8)
            )
            values.append((mu if friction_count == _POINTS else mu[indices]).reshape(ROAD_TILE, ROAD_TILE))
    except (ValueError, IndexError, struct.error):
        raise RoadFileError(f"{name} has a form that is not known.") from None
    return np.stack(values)
