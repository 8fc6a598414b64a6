"""Commands that repeat a run of a study, or show it in the viewer."""

from __future__ import annotations

import math
import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.processes import command_name
from ali3.reading import is_file
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import set_arguments
from hosts.driving.write_manoeuvre import write_manoeuvre
from hosts.study.folder import REPEAT, check_no_link
from hosts.study.plan import runs_of_folder
from hosts.study.store import study_record

if TYPE_CHECKING:
    from hosts.study.jobs import Job


@dataclass(frozen=True)
class Repeat:
    """Commands for a shell."""

    drive: str
    """Command that repeats the run and writes its table; empty for a manoeuvre under names of an alias file."""
    view: str
    """Command that shows the run; empty for a test."""


def repeater(folder: str | os.PathLike[str]) -> Callable[[int], Repeat]:
    """A function that returns the commands of a run by its number, and writes the file of its manoeuvre.

    Raises `HostError` if the folder is not a study folder or has a link, or its FMU is not the FMU of the rows; the
    function raises it if there is no such run.
    """
    path = Path(folder)
    record = study_record(path)
    check_no_link(path)
    runs = record["runs"]
    study, planned = runs_of_folder(path, record)
    aliases = ["--aliases", _alias_file(study.aliases, Path(record["file"]))] if study.aliases else []

    def repeat(index: int) -> Repeat:
        if not 0 <= index < runs:
            raise HostError(f"There is no run {index}; the study in {folder} has the runs 0 to {runs - 1}.")
        point, number = divmod(index, len(planned.jobs))
        values = {name: column[0] for name, column in planned.points.block(point, 1).items()}
        job, fmu = planned.jobs[number], path / record["fmu"]
        if job.manoeuvre is None:
            return _test_commands(job, fmu, values, aliases, path / REPEAT / f"run-{index}")
        if aliases:
            return Repeat("", "")  # the command run takes only the names of the FMU
        return _drive_commands(job, fmu, values, path / REPEAT / f"run-{index}.toml")

    return repeat


def _alias_file(name: str, file: Path) -> str:
    file_beside = file.parent / name
    return str(file_beside) if is_file(file_beside) else name


def _test_commands(job: Job, fmu: Path, values: Mapping[str, Value], aliases: Sequence[str], out: Path) -> Repeat:
    step = [] if math.isnan(job.step) else ["--step", repr(job.step)]
    settings = [argument for n, x in job.settings.items() for argument in ("--test-setting", f"{job.test}.{n}={x!r}")]
    arguments = [str(fmu), "--tests", job.test, *set_arguments({**job.start, **values}), *settings, *step, *aliases]
    return Repeat(_command_line("catalogue", [*arguments, "--out", str(out)]), "")


def _drive_commands(job: Job, fmu: Path, values: Mapping[str, Value], file: Path) -> Repeat:
    assert job.manoeuvre is not None
    write_manoeuvre(job.manoeuvre, file)
    arguments = [str(fmu), "-m", str(file), "--step", repr(job.step), *set_arguments(values), "--out", str(file.parent)]
    return Repeat(_command_line("run", arguments), _command_line("view", arguments))


def _command_line(command: str, arguments: list[str]) -> str:
    return f"{command_name(command)} {shlex.join(arguments)}"
