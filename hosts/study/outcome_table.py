"""The outcomes of a study in its folder: rows of a table in Parquet, and signals."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from hosts.study.parts import PartWriter, runs_done
from hosts.study.plan import Plan
from hosts.study.work import Outcome, Run

if TYPE_CHECKING:
    from hosts.study.signals import SignalWriter

Row: TypeAlias = tuple[Run, Outcome]

_MOST_ROWS = 50_000  # of a part
_MOST_BYTES = 200e6  # of signals that are kept before they are written


class OutcomeTable:
    """Where a `Kept` writes rows; the name of one is the number of its run."""

    def __init__(self, folder: Path, record: Mapping[str, Any], plan: Plan) -> None:
        self._done = runs_done(folder, record)
        self._writer = PartWriter(folder, record)
        self._signals: SignalWriter | None = None
        if plan.work.signals:
            from hosts.study.signals import SignalWriter, make_store

            for job in plan.work.jobs:
                if job.manoeuvre is not None:
                    make_store(folder, job, record)
            self._signals = SignalWriter(folder, plan.work.jobs, plan.work.signals)

    @property
    def is_full(self) -> bool:
        return len(self._writer) >= _MOST_ROWS or (self._signals is not None and self._signals.bytes > _MOST_BYTES)

    def lacks(self, name: str) -> bool:
        return name.isdecimal() and int(name) < len(self._done) and not self._done[int(name)]

    def take(self, name: str, row: Row) -> None:
        run, outcome = row
        self._writer.add(run, outcome)
        if self._signals is not None:
            self._signals.add(run, outcome)

    def write(self) -> None:
        if self._signals is not None:
            self._signals.flush()
        self._writer.flush()
