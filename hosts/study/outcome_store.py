"""Writes the outcomes of runs: each into a journal as it comes, many at once into the table and the signals."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hosts.common.closing import Closing
from hosts.experiment.journal import Journal
from hosts.study.folder import RUNS
from hosts.study.parts import PartWriter, runs_done
from hosts.study.plan import Plan
from hosts.study.work import Outcome, Run

if TYPE_CHECKING:
    from hosts.study.signals import SignalWriter

_FLUSH = (2.0, 60.0)  # s between parts, at least and at most
_FLUSH_PART = 0.02  # of the time so far
_MOST_ROWS = 50_000  # of a part
_MOST_BYTES = 200e6  # of signals that are kept before they are written


class OutcomeStore(Closing):
    """The outcomes in the folder of a study."""

    def __init__(self, folder: Path, record: Mapping[str, Any], plan: Plan) -> None:
        self._folder, self._record, self._plan = folder, record, plan
        self._journal: Journal[Outcome] = Journal(folder / RUNS / "journal", Outcome)
        self._writer = PartWriter(folder, record)
        self._signals: SignalWriter | None = None
        if plan.work.signals:
            from hosts.study.signals import SignalWriter, make_store

            for job in plan.work.jobs:
                if job.manoeuvre is not None:
                    make_store(folder, job, record)
            self._signals = SignalWriter(folder, plan.work.jobs, plan.work.signals)
        self._began = self._flushed = math.inf  # s, of the first outcome, and of the first that is not in a part

    def recover(self) -> None:
        """Take what a command that was killed had in its journal into the table."""
        if found := self._journal.read():
            done = runs_done(self._folder, self._record)
            for key, outcome in found.items():
                if key.isdecimal() and int(key) < len(done) and not done[int(key)]:
                    self._take(self._plan.runs_at([int(key)])[0], outcome)
        self.flush()

    def add(self, run: Run, outcome: Outcome) -> None:
        """Keep an outcome. Raises `FileError`: it cannot be written."""
        self._journal.add(str(run.index), outcome)
        self._take(run, outcome)
        now = clock.monotonic()
        self._began, self._flushed = min(now, self._began), min(now, self._flushed)
        wait = min(max(_FLUSH[0], _FLUSH_PART * (now - self._began)), _FLUSH[1])
        many = len(self._writer) >= _MOST_ROWS or (self._signals is not None and self._signals.bytes > _MOST_BYTES)
        if many or now - self._flushed > wait:
            self.flush()

    def flush(self) -> None:
        """Write the table and the signals. Raises `FileError`: they cannot be written; what was written stays."""
        if self._signals is not None:
            self._signals.flush()
        self._writer.flush()
        self._journal.clear()
        self._flushed = math.inf

    def close(self) -> None:
        """Close the journal, which has what was not flushed."""
        self._journal.close()

    def _take(self, run: Run, outcome: Outcome) -> None:
        self._writer.add(run, outcome)
        if self._signals is not None:
            self._signals.add(run, outcome)
