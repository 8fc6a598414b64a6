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
"""Unit in the first cell of a table: in brackets or parentheses, or alone at the end."""
SPACING_TOLERANCE = 1e-6
"""Largest deviation of coordinates from a regular grid, relative to its spacing."""
MAX_BYTES = 2**31


@dataclass(frozen=True)
class Grid:
    """A grid of numbers."""

    values: NDArray[np.float64]
    """Shape (nx, ny)."""
    origin: tuple[float, float] | None = None
    """x and y of the first point, m; None if the file has none."""
    spacing: tuple[float, float] | None = None
    """Distances of the points in x and y, m; None if the file has none."""
    frictions: NDArray[np.float64] | None = None
    """Shape (nx, ny); None if the file has none."""


def read_grid(path: str | os.PathLike[str], picture_range: tuple[float, float] | None, quantity: str) -> Grid:
    """Read a grid from a file.

    `path`: ``.csv`` or ``.txt``, ``.npy``, ``.npz`` or ``.png``; `picture_range`: values of black and white in a
    picture; `quantity`: "heights" or "frictions". Raises `RoadFileError` if the file cannot be read as a grid.
    """
    file = Path(path)
    kind = file.suffix.lower()
    if kind not in GRIDS:
        raise RoadFileError(
            f"{path} is not read as {quantity} of a road; its suffix must be one of {', '.join(GRIDS)}."
        )
    try:
        check_file(file, MAX_BYTES, RoadFileError)
        if kind in TABLES:
            grid = _read_table(file)
        elif kind == PICTURE:
            grid = _read_picture(file, picture_range, quantity)
        else:
            grid = _read_arrays(file, quantity)
    except OSError as error:
        raise RoadFileError(f"{path} cannot be read: {reason(error)}.") from None
    if grid.values.ndim != 2 or min(grid.values.shape) < 2:
        raise RoadFileError(
            f"The {quantity} in {path} have shape {grid.values.shape}; at least 2 x 2 points are needed."
        )
    for values in (grid.values, grid.frictions):
        if values is not None and not np.all(np.isfinite(values)):
            i, j = np.argwhere(~np.isfinite(values))[0].tolist()
            position = f"row {i + 1}, column {j + 1} of the points"
            raise RoadFileError(f"{path}: the value at {position} is {values[i, j]}, not a finite number.")
    return grid


def _read_table(file: Path) -> Grid:
    """Read rows along x and columns along y, with coordinates if the first cell is not a number.

    A second table with coordinates has the frictions. `mbs/kernel/src/roads/road_table.c` reads the same format.
    """
    table = TextTable(file, RoadFileError, headed=False, largest=MAX_BYTES)
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
    heights = _with_coordinates(table, [row for row in rows if row.line < second_line])
    if len(heading_lines) == 1:
        return heights
    frictions = _with_coordinates(table, [row for row in rows if row.line >= second_line])
    if (frictions.origin, frictions.spacing) != (heights.origin, heights.spacing):
        raise RoadFileError(f"{file}: the frictions have other coordinates than the heights.")
    if frictions.values.shape != heights.values.shape:
        raise RoadFileError(
            f"{file} has {len(heights.values)} rows of heights and {len(frictions.values)} of frictions."
        )
    return replace(heights, frictions=frictions.values)


def _check_comments(table: TextTable, first_line: int) -> None:
    """Raise `RoadFileError` if a comment above a table of numbers describes its columns."""
    for line, cells in table.comment_cells():
        numeric_cells = [cell for cell in cells[1:] if is_number(cell, table.decimal)]
        if line < first_line and len(numeric_cells) == len(cells) - 1 >= 2:
            raise RoadFileError(
                f"{table.name}, line {line} is a comment with a number for each column but the first, as the "
                "coordinates y of a grid; take its # away, or divide its numbers otherwise if they are none."
            )
        if line < first_line and {plain_name(cell) for cell in cells} >= {"x", "y"}:
            raise RoadFileError(
                f"{table.name}, line {line} names the columns {', '.join(cells)}: this is a list of points. A grid has "
                "a row for each x and a column for each y; as the points of a course in a world such a list is read."
            )


def _with_coordinates(table: TextTable, rows: list[Row]) -> Grid:
    """Make a grid from rows with coordinates in the first row and column."""
    y = np.array(table.numbers(rows[0], first=1)) if table.width > 1 else np.zeros(0)
    if len(rows) < 3 or len(y) < 2:
        raise RoadFileError(f"{table.name} has {len(rows) - 1} x {len(y)} points; at least 2 x 2 are needed.")
    body = np.array([table.numbers(row) for row in rows[1:]])
    (x0, dx), (y0, dy) = _origin_and_spacing(body[:, 0], "x", table.name), _origin_and_spacing(y, "y", table.name)
    return Grid(body[:, 1:], (x0, y0), (dx, dy))


def _origin_and_spacing(values: NDArray[np.float64], name: str, path: object) -> tuple[float, float]:
    """First value and spacing of ascending coordinates, m; `name`: "x" or "y"."""
    spacing = float((values[-1] - values[0]) / (len(values) - 1))
    if not (math.isfinite(spacing) and spacing > 0.0):
        raise RoadFileError(f"{path}: the coordinates {name} do not ascend.")
    deviations = np.abs(values - (values[0] + spacing * np.arange(len(values))))
    k = int(np.argmax(deviations))
    if not deviations[k] <= SPACING_TOLERANCE * spacing + 1e-12 * float(np.abs(values).max()):
        expected = values[0] + spacing * k
        raise RoadFileError(
            f"{path}: the coordinates {name} are not regular: {values[k]:.12g} should be {expected:.12g}."
        )
    return float(values[0]), spacing


def _read_arrays(file: Path, quantity: str) -> Grid:
    """Read a grid from a file of NumPy arrays."""
    arrays = read_arrays(file, MAX_BYTES, RoadFileError)
    if file.suffix.lower() == ".npy":
        return Grid(_as_floats(arrays[""], file))
    keys = {"heights", "frictions", "origin", "spacing"}
    if unknown := sorted(set(arrays) - keys):
        raise RoadFileError(f"{file} has an array '{unknown[0]}'; known are {', '.join(sorted(keys))}.")
    if quantity not in arrays:
        raise RoadFileError(f"{file} has no array '{quantity}'.")
    pairs = {
        name: _as_pair(_as_floats(arrays[name], file), f"'{name}' in {file}")
        for name in ("origin", "spacing")
        if name in arrays
    }
    frictions = _as_floats(arrays["frictions"], file) if "frictions" in arrays and quantity == "heights" else None
    return Grid(_as_floats(arrays[quantity], file), pairs.get("origin"), pairs.get("spacing"), frictions)


def _as_floats(values: NDArray[np.generic], file: Path) -> NDArray[np.float64]:
    """Convert real numbers to floats. Raises `RoadFileError` if they are of another type."""
    if values.dtype.kind not in "fiu":
        raise RoadFileError(f"{file} has values of type {values.dtype}; real numbers are needed.")
    return values.astype(float)


def _as_pair(values: NDArray[np.float64], subject: str) -> tuple[float, float]:
    """Numbers for x and y from an array of one or two. Raises `RoadFileError` if it has another shape."""
    if values.shape not in ((2,), (1,), ()):
        raise RoadFileError(f"{subject} has shape {values.shape}; it is one number or two, of x and y.")
    first, *rest = np.atleast_1d(values).tolist()
    return float(first), float(rest[0] if rest else first)


def _read_picture(file: Path, picture_range: tuple[float, float] | None, quantity: str) -> Grid:
    """Read a picture seen from above, x to the right and y up; black and white are the ends of the range."""
    try:
        from PIL import Image, UnidentifiedImageError
    except ModuleNotFoundError:
        raise RoadFileError(f"{file} is a picture. {missing_package('PIL', 'roads')}") from None
    if picture_range is None:
        raise RoadFileError(f"{file} is a picture: say which {quantity} black and white mean, as in --range 0 0.25.")
    try:
        # from memory: Pillow then allocates nothing for a damaged length beyond the end
        stream = io.BytesIO(read_bytes(file, MAX_BYTES, RoadFileError))
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
    return Grid(np.ascontiguousarray((picture_range[0] + (picture_range[1] - picture_range[0]) * grey)[::-1].T))
