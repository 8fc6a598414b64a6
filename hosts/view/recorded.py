"""Reads tables of results: those of the hosts, of `mbs` runs, and others with a column of times."""

from __future__ import annotations

import csv
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.files import reason
from hosts.common.errors import HostError

_HEADING = re.compile(r"(?P<name>.*) \[(?P<unit>[^\[\]]*)\]")
_MOST_VALUES = 8_000_000  # that are read: 64 MB
_FEWEST_ROWS = 20_000


@dataclass(frozen=True)
class Table:
    """A table of results.

    Parameters
    ----------
    t : ndarray of shape (n,)
        s.
    columns : dict of str to ndarray of shape (n,)
        By name.
    units : dict of str to str
        Where the headings give them.
    note : str
        A sentence where not all rows were read, else empty.
    """

    t: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    units: dict[str, str]
    note: str


def read_table(path: Path) -> Table:
    """Read a table whose first column is the time.

    Parameters
    ----------
    path : Path
        CSV: headings ``time`` and names, or ``time [s]`` and ``name [unit]``; lines that begin with ``#`` are left out.
        Of a table that would fill the memory every so many rows are read.

    Raises
    ------
    HostError
        It cannot be read, or is no such table; one sentence with file, line and reason.
    """
    try:
        with path.open("rb") as stream:
            rows = sum(block.count(b"\n") for block in iter(lambda: stream.read(1 << 20), b""))
        with path.open(encoding="utf-8-sig", newline="") as text:
            return _read(path, text, rows)
    except OSError as error:
        raise HostError(f"{path} cannot be read: {reason(error)}.") from None
    except UnicodeDecodeError:
        raise HostError(f"{path} is no table of text: it is not in UTF-8.") from None
    except csv.Error as error:
        raise HostError(f"{path} is no table of results: {error}.") from None


def _read(path: Path, text: Iterator[str], rows: int) -> Table:
    lines = (line for line in text if line.strip() and not line.startswith("#"))
    names, units = _heading(path, next(lines, ""))
    every = max(1, -(-rows // max(_FEWEST_ROWS, _MOST_VALUES // len(names))))
    chosen = (line for k, line in enumerate(lines) if k % every == 0)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            data = np.loadtxt(chosen, delimiter=",", comments=None, quotechar='"', ndmin=2)
    except UserWarning:
        raise HostError(f"{path} holds no values; it needs a heading and at least one row.") from None
    except ValueError as error:
        raise HostError(f"{path} is no table of results: {_words(str(error), every)}.") from None
    if data.shape[1] != len(names):
        raise HostError(f"{path}: {data.shape[1]} values in a row where the heading has {len(names)} columns.")
    note = f"One of every {every} of about {rows - 1} rows of {path.name} was read." if every > 1 else ""
    columns = {name: np.ascontiguousarray(data[:, k]) for k, name in enumerate(names) if k}
    return Table(np.ascontiguousarray(data[:, 0]), columns, units, note)


def _heading(path: Path, line: str) -> tuple[list[str], dict[str, str]]:
    cells = next(csv.reader([line]), [])
    matches = [_HEADING.fullmatch(cell) for cell in cells]
    with_units = bool(cells) and matches[0] is not None
    names = [
        m["name"] if with_units and m is not None else cell.strip() for m, cell in zip(matches, cells, strict=True)
    ]
    units = {m["name"]: m["unit"] for m in matches if with_units and m is not None}
    if not names or names[0] != "time":
        first = f"{cells[0][:40]!r}" if cells else "nothing"
        raise HostError(f"{path} is no table of results: its heading begins with {first}; it must be time.")
    if len(names) < 2:
        raise HostError(f"{path} has a column of times and no other.")
    twice = next((name for k, name in enumerate(names) if name in names[:k]), None)
    if twice is not None:
        raise HostError(f"{path} has the column {twice!r} twice.")
    return names, units


def _words(message: str, every: int) -> str:
    """NumPy's message in our words; rows are counted as they stand in the file, the heading is row 1."""
    found = re.search(r"could not convert string (.*) to float64 at row (\d+), column (\d+)", message)
    if found:
        row = int(found[2]) * every + 2
        return f"{found[1]} in row {row}, column {found[3]}, is no number"
    found = re.search(r"number of columns changed from (\d+) to (\d+) at row (\d+)", message)
    if found:
        return f"row {(int(found[3]) - 1) * every + 2} has {found[2]} values where those before have {found[1]}"
    return " ".join(message.rstrip(".").split())[:200]
