"""Commands that repeat a run of a study as a drive or show it in the viewer."""

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
from hosts.common.set_arguments import set_arguments
from hosts.driving.write_manoeuvre import write_manoeuvre
from hosts.study.folder import REPEAT, check_no_link
from hosts.study.plan import runs_of_folder
from hosts.study.store import study_record

if TYPE_CHECKING:
    from hosts.study.jobs import Job


@dataclass(frozen=True)
class Repeat:
    """Lines for a shell."""

    drive: str
    """Makes the run again and writes its table, or does the test again; empty for a manoeuvre under names of an alias
    file."""
    view: str
    """Shows it moving; empty for a test."""


def repeater(folder: str | os.PathLike[str]) -> Callable[[int], Repeat]:
    """A function that gives the commands of a run by its number, and writes the manoeuvre that they name.

    Raises `HostError`: the folder is of no study, has a link in it, or another FMU than the one that made the rows; the
    function raises it where there is no such run.
    """
    place = Path(folder)
    record = study_record(place)
    check_no_link(place)
    runs = record["runs"]
    study, planned = runs_of_folder(place, record)
    aliases = ["--aliases", _alias_file(study.aliases, Path(record["file"]))] if study.aliases else []

    def repeat(index: int) -> Repeat:
        if not 0 <= index < runs:
            raise HostError(f"There is no run {index}; the study in {folder} has the runs 0 to {runs - 1}.")
        point, number = divmod(index, len(planned.jobs))
        values = {name: column[0] for name, column in planned.points.block(point, 1).items()}
        job, fmu = planned.jobs[number], place / record["fmu"]
        if job.manoeuvre is None:
            return _test(job, fmu, values, aliases, place / REPEAT / f"run-{index}")
        if aliases:
            return Repeat("", "")  # the command run knows the names of the FMU only
        return _drive(job, fmu, values, place / REPEAT / f"run-{index}.toml")

    return repeat


def _alias_file(name: str, file: Path) -> str:
    beside = file.parent / name
    return str(beside) if is_file(beside) else name


def _test(job: Job, fmu: Path, values: Mapping[str, Value], aliases: Sequence[str], out: Path) -> Repeat:
    step = [] if math.isnan(job.step) else ["--step", repr(job.step)]
    settings = [part for n, x in job.settings.items() for part in ("--test-setting", f"{job.test}.{n}={x!r}")]
    arguments = [str(fmu), "--tests", job.test, *set_arguments({**job.start, **values}), *settings, *step, *aliases]
    return Repeat(_line("catalogue", [*arguments, "--out", str(out)]), "")


def _drive(job: Job, fmu: Path, values: Mapping[str, Value], file: Path) -> Repeat:
    assert job.manoeuvre is not None
    write_manoeuvre(job.manoeuvre, file)
    arguments = [str(fmu), "-m", str(file), "--step", repr(job.step), *set_arguments(values), "--out", str(file.parent)]
    return Repeat(_line("run", arguments), _line("view", arguments))


def _line(command: str, arguments: list[str]) -> str:
    return f"{command_name(command)} {shlex.join(arguments)}"
