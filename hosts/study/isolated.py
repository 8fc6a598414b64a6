"""Runs in a process of their own: one that crashes or hangs takes nothing with it, and is known by its number."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ali3.isolated import Isolated, Lost
from hosts.common.numbers import Value
from hosts.fmu.own_process import PATIENCE, files_of
from hosts.study.job import Job
from hosts.study.one_run import Bench, Task
from hosts.study.work import FAILED, Outcome, Work


class IsolatedBench:
    """A `Bench` in a process of its own; after a crash or a run that took too long, in a new one."""

    def __init__(self, work: Work, path: Path) -> None:
        self._limit = work.time_limit
        started = [job.manoeuvre.start for job in work.jobs if job.manoeuvre is not None]
        reads = [path, *(file for values in started for file in files_of(values))]
        self._bench: Isolated[Task, Outcome] = Isolated(Bench(work, path.absolute()), Outcome, reads=reads)

    def run(self, job: Job, values: Mapping[str, Value], seed: int) -> Outcome:
        outcome = self._bench.do((job, values, seed), limit=PATIENCE if self._limit is None else self._limit)
        if not isinstance(outcome, Lost):
            return outcome
        if outcome.late:
            which = "" if self._limit is None else " (time_limit)"
            return Outcome(FAILED, f"The run {outcome.how}{which}.", wall=self._limit or 0.0)
        return Outcome(FAILED, f"The process of the run {outcome.how}.")

    def close(self) -> None:
        """End the process."""
        self._bench.close()
