"""Runs a task with an FMU in an isolated process, so that a crash of its library is only an error."""

from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from pathlib import Path
from typing import Any, TypeVar

from ali3.errors import UserError
from ali3.isolated_processes import Isolated, Lost, Tell
from hosts.common.errors import FailedFmuError, HostError
from hosts.common.numbers import Value
from hosts.common.road import report_starts

PATIENCE = 300.0
"""Longest time of a step, a start or the end of an FMU, s."""

_Task = TypeVar("_Task")
_Result = TypeVar("_Result")


def files_of(values: Mapping[str, Value]) -> list[Path]:
    """Files that values of variables of an FMU may name."""
    return [Path(value) for value in values.values() if isinstance(value, str) and Path(value).suffix]


def files_of_drives(fmu: Path, starts: Iterable[Mapping[str, Value]]) -> list[Path]:
    """Files that drives of an FMU read; starts outside of the road are reported."""
    drive_starts = list(starts)
    report_starts(drive_starts)
    return [fmu, *(file for start in drive_starts for file in files_of(start))]


def in_own_process(
    work: Callable[[_Task, Tell], _Result],
    task: _Task,
    answer: Any,
    reads: Iterable[Path],
    tell: Callable[[float], None] = lambda done: None,
) -> _Result:
    """Run one task in an isolated process. `work`, `answer`, `reads`: see `Isolated`; `tell`: called with its progress.

    Raises `HostError` if the work has raised a `UserError`, `FailedFmuError` if the process has ended.
    """
    process: Isolated[_Task, _Result] = Isolated(work, answer, reads=reads)
    with closing(process):
        try:
            result = process.do(task, tell, PATIENCE)
        except UserError as error:
            host_error = HostError(str(error))
            host_error.status = error.status
            raise host_error from None
    if isinstance(result, Lost):
        raise FailedFmuError(f"The process of the FMU {result.how}.")
    return result
