"""The outcomes of a study in its folder, as a table of a `Kept`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

from hosts.study.parts import PartWriter, runs_done
from hosts.study.worker_data import Outcome, Run

Row: TypeAlias = tuple[Run, Outcome]

_MOST_ROWS = 50_000  # of a part
_MOST_BYTES = 200e6  # of signals that are kept before they are written


class OutcomeTable:
    """Where a `Kept` writes rows; the name of one is the number of its run."""

    def __init__(self, folder: Path, record: Mapping[str, Any]) -> None:
        self._done = runs_done(folder, record)
        self._writer = PartWriter(folder, record)

    @property
    def is_full(self) -> bool:
        return len(self._writer) >= _MOST_ROWS or self._writer.bytes > _MOST_BYTES

    def lacks(self, name: str) -> bool:
        return name.isdecimal() and int(name) < len(self._done) and not self._done[int(name)]

    def take(self, name: str, row: Row) -> None:
        self._writer.add(*row)

    def write(self) -> None:
        self._writer.flush()
