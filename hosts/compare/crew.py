"""Processes that share the stretches of a replay, each with the FMU loaded once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from ali3.isolated import Lost
from hosts.common.errors import FailedFmuError
from hosts.common.numbers import Value
from hosts.compare.stretch_fmu import StretchFmu
from hosts.compare.stretches import Stretch
from hosts.driving.result import Result
from hosts.experiment.pool import Pool
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu import StartRefusedError
from hosts.fmu.own_process import files_of

_Task = tuple[int, dict[str, Value], bool | None]


class _Member:
    """What a process does: it drives the stretch of a number."""

    def __init__(self, fmu: StretchFmu, stretches: Sequence[Stretch]) -> None:
        self._fmu, self._stretches = fmu, list(stretches)

    def __call__(self, task: _Task, tell: Callable[[Any], None]) -> Result | str:
        """The result, or why the FMU does not start with these values: no error, which would end the others."""
        number, values, self._fmu.can_reset = task
        try:
            return self._fmu.drive(self._stretches[number], values, tell)
        except StartRefusedError as error:
            return str(error)


class Crew:
    """Processes that drive stretches. `step`: communication step, s."""

    def __init__(self, path: Path, aliases: Aliases, stretches: Sequence[Stretch], step: float, jobs: int) -> None:
        self._stretches = list(stretches)
        reads = [path, *(file for stretch in stretches for file in files_of(stretch.manoeuvre.start))]
        member = _Member(StretchFmu(path.absolute(), aliases, step), stretches)
        self._pool: Pool[_Task, Result | str] = Pool(member, Result | str, min(jobs, len(stretches)), reads)

    def drive_first(self, can_reset: bool) -> Result:
        """Drive the first stretch, each time by the same process."""
        return self._result(0, self._pool.run((0, {}, can_reset)))

    def _result(self, number: int, result: Result | str | Lost) -> Result:
        if isinstance(result, str):
            raise StartRefusedError(result)
        if not isinstance(result, Lost):
            return result
        fewer = " --jobs 1 takes less memory." if len(self._pool) > 1 else ""
        begin = self._stretches[number].begin
        raise FailedFmuError(f"The process that drove the window from {begin:g} s {result.how}.{fewer}")

    def drive(self, values: Mapping[str, Value] | None, can_reset: bool | None) -> list[Result]:
        """Drive all stretches; results in their order. Raises `FailedFmuError`: a process has ended."""
        tasks: list[_Task] = [(k, dict(values or {}), can_reset) for k in range(len(self._stretches))]
        results = dict(self._pool.results(tasks))
        return [self._result(k, results[k]) for k in range(len(tasks))]

    def close(self) -> None:
        """End the processes."""
        self._pool.close()
