"""Grids of numbers from CSV tables, NumPy arrays and pictures; each as rows along x and columns along y."""

import io
import math
import os
import re
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.arrays import read_arrays
from ali3.errors import reason
from ali3.extras import missing_package
from ali3.message_text import brief
from ali3.reading import check_file, read_bytes
from ali3.tables import Row, TextTable, is_number, plain_name
from mbs.roads.kinds import GRIDS, PICTURE, TABLES
from mbs.roads.road_header import RoadFileError

UNIT = re.compile(r"[\[(]\s*(?P<unit>[^\[\]()]*?)\s*[\])]$|(?:^|[\s_,;/\\])(?P<bare>[kcm]m|m|in|ft)$")
"""A unit of a first cell: in brackets or parentheses, or a bare one at the end."""
REGULAR = 1e-6
"""Coordinates of a table may be off a regular grid by this part of its spacing."""
MOST_BYTES = 2**31


@dataclass(frozen=True)
class Grid:
    """A grid of numbers."""

    values: NDArray[np.float64]
    """Shape (nx, ny)."""
    origin: tuple[float, float] | None = None
    spacing: tuple[float, float] | None = None
    """`origin`, `spacing`: of its points in x and y, m, where the file says it."""
    frictions: NDArray[np.float64] | None = None
    """Shape (nx, ny): where the same file has them."""


def read_grid(path: str | os.PathLike[str], picture_range: tuple[float, float] | None, what: str) -> Grid:
    """A grid from a file.

    `path`: ``.csv`` or ``.txt``, ``.npy``, ``.npz`` or ``.png``; `picture_range`: what black and white of a picture
    mean; `what`: "heights" or "frictions". Raises `RoadFileError` with the file and what is wrong with it.
    """
    file = Path(path)
    kind = file.suffix.lower()
    if kind not in GRIDS:
        raise RoadFileError(f"{path} is not read as {what} of a road; its suffix must be one of {', '.join(GRIDS)}.")
    try:
        check_file(file, MOST_BYTES, RoadFileError)
        if kind in TABLES:
            grid = _table(file)
        elif kind == PICTURE:
            grid = _picture(file, picture_range, what)
        else:
            grid = _arrays(file, what)
    except OSError as error:
        raise RoadFileError(f"{path} cannot be read: {reason(error)}.") from None
    if grid.values.ndim != 2 or min(grid.values.shape) < 2:
        raise RoadFileError(f"The {what} in {path} have shape {grid.values.shape}; at least 2 x 2 points are needed.")
    for values in (grid.values, grid.frictions):
        if values is not None and not np.all(np.isfinite(values)):
            i, j = np.argwhere(~np.isfinite(values))[0].tolist()
            position = f"row {i + 1}, column {j + 1} of the points"
            raise RoadFileError(f"{path}: the value at {position} is {values[i, j]}, not a finite number.")
    return grid


def _table(file: Path) -> Grid:
    """Rows are along x, columns along y; with coordinates where the first cell is not a number.

    Such a table may be followed by another one for the frictions. `mbs/kernel/src/roads/road_table.c` reads the same.
    """
    table = TextTable(file, RoadFileError, headed=False, largest=MOST_BYTES)
    rows = list(table.rows())
    if len(rows) < 2:
        raise RoadFileError(f"{file} has {len(rows)} rows; a grid needs at least two.")
    heading_lines = [row.line for row in rows if not is_number(row.cells[0], table.decimal)]
    if not heading_lines or heading_lines[0] != rows[0].line:
        _check_comments(table, rows[0].line)
        return Grid(np.array([table.numbers(row) for row in rows]))
    corner = rows[0].cells[0]
    unit = UNIT.search(corner)
    if unit is not None and (unit["unit"] or unit["bare"]) not in ("m", "metre", "meter", "metres", "meters"):
        raise RoadFileError(f"{file}: its first cell is {brief(corner)}; coordinates and heights must be in m.")
    if len(heading_lines) > 2:
        raise RoadFileError(f"{file}, line {heading_lines[2]} begins a third table; there are heights and frictions.")
    second_line = heading_lines[1] if len(heading_lines) > 1 else math.inf
    heights = _labelled(table, [row for row in rows if row.line < second_line])
    if len(heading_lines) == 1:
        return heights
    frictions = _labelled(table, [row for row in rows if row.line >= second_line])
    if (frictions.origin, frictions.spacing) != (heights.origin, heights.spacing):
        raise RoadFileError(f"{file}: the frictions have other coordinates than the heights.")
    if frictions.values.shape != heights.values.shape:
        raise RoadFileError(
            f"{file} has {len(heights.values)} rows of heights and {len(frictions.values)} of frictions."
        )
    return replace(heights, frictions=frictions.values)


def _check_comments(table: TextTable, first: int) -> None:
    """A comment above a table of numbers alone that says what its columns are is not passed over."""
    for line, cells in table.comment_cells():
        numeric_cells = [cell for cell in cells[1:] if is_number(cell, table.decimal)]
        if line < first and len(numeric_cells) == len(cells) - 1 >= 2:
            raise RoadFileError(
                f"{table.name}, line {line} is a comment with a number for each column but the first, as the "
                "coordinates y of a grid; take its # away, or divide its numbers otherwise if they are none."
            )
        if line < first and {plain_name(cell) for cell in cells} >= {"x", "y"}:
            raise RoadFileError(
                f"{table.name}, line {line} names the columns {', '.join(cells)}: this is a list of points. A grid has "
                "a row for each x and a column for each y; as the points of a course in a world such a list is read."
            )


def _labelled(table: TextTable, rows: list[Row]) -> Grid:
    """A table with its coordinates."""
    y = np.array(table.numbers(rows[0], first=1)) if table.width > 1 else np.zeros(0)
    if len(rows) < 3 or len(y) < 2:
        raise RoadFileError(f"{table.name} has {len(rows) - 1} x {len(y)} points; at least 2 x 2 are needed.")
    body = np.array([table.numbers(row) for row in rows[1:]])
    (x0, dx), (y0, dy) = _regular(body[:, 0], "x", table.name), _regular(y, "y", table.name)
    return Grid(body[:, 1:], (x0, y0), (dx, dy))


def _regular(values: NDArray[np.float64], name: str, path: object) -> tuple[float, float]:
    """First value and spacing of ascending coordinates."""
    spacing = float((values[-1] - values[0]) / (len(values) - 1))
    if not (math.isfinite(spacing) and spacing > 0.0):
        raise RoadFileError(f"{path}: the coordinates {name} do not ascend.")
    deviations = np.abs(values - (values[0] + spacing * np.arange(len(values))))
    k = int(np.argmax(deviations))
    if not deviations[k] <= REGULAR * spacing + 1e-12 * float(np.abs(values).max()):
        expected = values[0] + spacing * k
        raise RoadFileError(
            f"{path}: the coordinates {name} are not regular: {values[k]:.12g} should be {expected:.12g}."
        )
    return float(values[0]), spacing


def _arrays(file: Path, what: str) -> Grid:
    arrays = read_arrays(file, MOST_BYTES, RoadFileError)
    if file.suffix.lower() == ".npy":
        return Grid(_real(arrays[""], file))
    keys = {"heights", "frictions", "origin", "spacing"}
    if unknown := sorted(set(arrays) - keys):
        raise RoadFileError(f"{file} has an array '{unknown[0]}'; known are {', '.join(sorted(keys))}.")
    if what not in arrays:
        raise RoadFileError(f"{file} has no array '{what}'.")
    pairs = {
        name: _pair(_real(arrays[name], file), f"'{name}' in {file}")
        for name in ("origin", "spacing")
        if name in arrays
    }
    frictions = _real(arrays["frictions"], file) if "frictions" in arrays and what == "heights" else None
    return Grid(_real(arrays[what], file), pairs.get("origin"), pairs.get("spacing"), frictions)


def _real(values: NDArray[np.generic], file: Path) -> NDArray[np.float64]:
    if values.dtype.kind not in "fiu":
        raise RoadFileError(f"{file} has values of type {values.dtype}; real numbers are needed.")
    return values.astype(float)


def _pair(values: NDArray[np.float64], what: str) -> tuple[float, float]:
    if values.shape not in ((2,), (1,), ()):
        raise RoadFileError(f"{what} has shape {values.shape}; it is one number or two, of x and y.")
    first, *rest = np.atleast_1d(values).tolist()
    return float(first), float(rest[0] if rest else first)


def _picture(file: Path, limits: tuple[float, float] | None, what: str) -> Grid:
    """Seen from above, x to the right and y up; black and white are the ends of the range."""
    try:
        from PIL import Image, UnidentifiedImageError
    except ModuleNotFoundError:
        raise RoadFileError(f"{file} is a picture. {missing_package('PIL', 'roads')}") from None
    if limits is None:
        raise RoadFileError(f"{file} is a picture: say which {what} black and white mean, as in --range 0 0.25.")
    try:
        # from memory, where what a damaged length asks for beyond the end is not made room for
        stream = io.BytesIO(read_bytes(file, MOST_BYTES, RoadFileError))
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)  # at 90 million pixels, 3 GB of memory
            image = Image.open(stream)
            white = {"L": 255.0, "I;16": 65535.0, "I;16B": 65535.0, "I": 65535.0, "1": 1.0}.get(image.mode)
            if white is None:
                raise RoadFileError(f"{file} is a picture of mode {image.mode}; 8 or 16 bits of grey are needed.")
            grey = np.asarray(image, float) / white
    except RoadFileError:
        raise
    except (UnidentifiedImageError, Image.DecompressionBombError, RuntimeWarning, ValueError, SyntaxError) as error:
        raise RoadFileError(f"{file} cannot be read as a picture: {str(error).rstrip('.')}.") from None
    return Grid(np.ascontiguousarray((limits[0] + (limits[1] - limits[0]) * grey)[::-1].T))
