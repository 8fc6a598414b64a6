"""Processes of this machine that make runs of a study."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from pathlib import Path

from ali3.isolated import Lost
from hosts.common.closing import Closing
from hosts.common.road import tell_starts
from hosts.experiment.pool import Pool
from hosts.fmu.own_process import PATIENCE, files_of
from hosts.study.one_run import Bench
from hosts.study.work import FAILED, Outcome, Run, Work


class RunProcesses(Closing):
    """Processes with a `Bench` each; that a run crashed or took too long is its outcome. `jobs`: how many."""

    def __init__(self, work: Work, path: Path, jobs: int = 1) -> None:
        self._limit = work.time_limit
        started = [job.manoeuvre.start for job in work.jobs if job.manoeuvre is not None]
        reads = [path, *(file for start in started for file in files_of(start))]
        limit = PATIENCE if work.time_limit is None else work.time_limit
        self._started = started or [{}]
        self._pool: Pool[Run, Outcome] = Pool(Bench(work, path.absolute()), Outcome, jobs, reads, limit)

    def close(self) -> None:
        """End the processes."""
        self._pool.close()

    def run(self, run: Run) -> Outcome:
        """Make a run, each time in the same process."""
        self._tell(run)
        return self._outcome(self._pool.run(run))

    def _tell(self, run: Run) -> None:
        tell_starts({**start, **run.values} for start in self._started)

    def outcomes(self, runs: Iterable[Run]) -> Generator[tuple[Run, Outcome]]:
        """Make runs; give each with its outcome as soon as it is there."""
        sent: dict[int, Run] = {}

        def remembered() -> Iterator[Run]:
            for number, run in enumerate(runs):
                sent[number] = run
                self._tell(run)
                yield run

        for number, result in self._pool.results(remembered()):
            yield sent.pop(number), self._outcome(result)

    def _outcome(self, result: Outcome | Lost) -> Outcome:
        if not isinstance(result, Lost):
            return result
        if result.late:
            which = "" if self._limit is None else " (time_limit)"
            return Outcome(FAILED, f"The run {result.how}{which}.", wall=self._limit or 0.0)
        return Outcome(FAILED, f"The process of the run {result.how}.")
