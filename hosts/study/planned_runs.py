"""What a study runs: points and what is done at each of them, checked against an FMU."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hosts.common.errors import HostError
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.aliased_fmu import seen_through
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu import Fmu
from hosts.fmu.variables import Variable
from hosts.study.folder import fmu_of_folder
from hosts.study.job import Job
from hosts.study.jobs import jobs_of
from hosts.study.other_names import aliases_beside, renamed_variable
from hosts.study.parameters import parameter_of
from hosts.study.points import Points, sampled_points
from hosts.study.study_file import StudyFile, read_study_file
from hosts.study.table_points import table_points


@dataclass(frozen=True)
class PlannedRuns:
    """Runs of a study."""

    fmu: SimulatedFmu
    """Under our names, where there is an alias file."""
    names: Aliases
    """Ours for its variables."""
    points: Points
    parameters: dict[str, Any]
    """A record of each parameter by its name."""
    jobs: list[Job]
    """What is done at each point."""


def planned_runs(study: StudyFile, file: Path, opened: Fmu) -> PlannedRuns:
    """The runs of a study file. `file`: where it was read from; files it names are looked for beside it.

    Raises `HostError`: an unknown parameter, a value out of range with its row, an empty grid, a manoeuvre that
    overwrites a parameter.
    """
    names = Aliases() if study.aliases is None else aliases_beside(study.aliases, file, opened)
    fmu: SimulatedFmu = seen_through(opened, names)
    points, parameters = _points(study, file, opened, fmu)
    return PlannedRuns(fmu, names, points, parameters, jobs_of(study, file, fmu, list(parameters)))


def runs_of_folder(folder: Path, record: dict[str, Any]) -> tuple[StudyFile, PlannedRuns]:
    """The study whose results a folder holds, and its runs; `HostError` where its FMU is another one."""
    study, _ = read_study_file(folder / "study.toml")
    with Fmu(fmu_of_folder(folder, record)) as opened:
        return study, planned_runs(study, Path(record["file"]), opened)


def _points(study: StudyFile, file: Path, opened: Fmu, fmu: SimulatedFmu) -> tuple[Points, dict[str, Any]]:
    """Points, and a record of each parameter."""

    def variable_of(name: str, where: str) -> Variable:
        return renamed_variable(fmu, name, where) or opened.table.settable(name, where)

    for name, value in study.start.items():
        variable_of(name, f"{file}: start").check(value, f"{file}: start")
    if study.sampling.method == "table":
        assert study.sampling.file is not None
        table = table_points(file.parent / study.sampling.file, variable_of, study.parameters)
        names = list(table.block(0, 0))
        both = sorted(set(names) & set(study.start))
        if both:
            raise HostError(f"{file}: '{both[0]}' is a column of {study.sampling.file} and in [start]; give it once.")
        variables = {n: variable_of(n, "") for n in names}
        return table, {n: {"kind": v.kind, "unit": v.unit} for n, v in variables.items()}
    if not study.parameters:
        raise HostError(f"{file}: it has no parameters; a grid of none is empty.")
    parameters = tuple(
        parameter_of(name, entry, variable_of(name, f"{file}: parameters"), str(file))
        for name, entry in study.parameters.items()
    )
    points = sampled_points(parameters, study.sampling, str(file))
    return points, {p.name: p for p in points.parameters}
