"""Reads tables of results: those of the hosts, of `mbs` runs, and others with a column of times."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import brief
from ali3.reading import open_file
from ali3.tables import LARGEST, TextTable
from hosts.common.errors import HostError

_MOST_VALUES = 8_000_000  # that are read: 64 MB
_FEWEST_ROWS = 20_000


@dataclass(frozen=True)
class Table:
    """A table of results."""

    t: NDArray[np.float64]
    """Shape (n,): s."""
    columns: dict[str, NDArray[np.float64]]
    """Each of shape (n,): by name."""
    units: dict[str, str]
    """By name, as far as the headings give them."""
    note: str
    """A sentence if not all rows were read, else empty."""


def read_table(path: Path) -> Table:
    """Read a table whose first column is the time.

    `path`: CSV: headings ``time`` and names, or ``time [s]`` and ``name [unit]``; lines that begin with ``#`` are left
    out. Of a table that would fill the memory one of several rows is read. Raises `HostError`: it cannot be read, or is
    no such table; one sentence with file, line and reason.
    """
    text = TextTable(path, HostError, known=("time",), units=True)
    if text.names[0] != "time":
        raise HostError(
            f"{path} is not a table of results: its heading begins with {brief(text.names[0])}; it must be time."
        )
    if text.width < 2:
        raise HostError(f"{path} has a column of times and no other.")
    with open_file(path, LARGEST, HostError) as stream:
        rows = sum(block.count(b"\n") for block in iter(lambda: stream.read(1 << 20), b""))
    stride = max(1, -(-rows // max(_FEWEST_ROWS, _MOST_VALUES // text.width)))
    data = text.values(stride, finite=False)
    note = f"One of every {stride} of about {rows - 1} rows of {path.name} was read." if stride > 1 else ""
    columns = {name: np.ascontiguousarray(data[:, k]) for k, name in enumerate(text.names) if k}
    return Table(np.ascontiguousarray(data[:, 0]), columns, text.units, note)
