"""A study that has been checked against its FMU: its runs, and the columns of its table."""

import hashlib
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.archives import LARGEST_ARCHIVE
from ali3.near_names import did_you_mean
from ali3.reading import is_file, read_bytes
from hosts.common.errors import HostError
from hosts.common.program import program_digest, versions
from hosts.driving.manoeuvre import digest as manoeuvre_digest
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.named_fmu import NamedFmu
from hosts.fmu.variables import Variable
from hosts.study.folder import fmu_of_folder
from hosts.study.jobs import Job, jobs_of
from hosts.study.measures.study_measure import StudyMeasure, parse_measure
from hosts.study.parameters import Parameter, parameter_of
from hosts.study.points import Points, digest, sampled_points, table_points
from hosts.study.study_file import ManoeuvreEntry, StudyFile, read_study_file
from hosts.study.worker_data import ALL, Run, Work

OWN_COLUMNS = (
    *("index", "point", "manoeuvre", "seed"),
    *("status", "reason", "missing", "messages", "simulated", "wall_seconds"),
)


def fmu_source_of(name: str | None, file: Path, fmu: Fmu) -> FmuSource:
    """The FMU under the names of an alias file beside the study file, otherwise of the package; `name` None: its own
    names.

    Raises `HostError` if the alias file is wrong, or is not for this FMU.
    """
    file_beside = None if name is None else file.parent / name
    return FmuSource.named(
        fmu.path, fmu.table, file_beside if file_beside is not None and is_file(file_beside) else name
    )


def variable_by_ali3_name(fmu: SimulatedFmu, name: str, where: str) -> Variable | None:
    """A variable that can be set, by ALi3 name and in ALi3 units; None if there is no such name.

    Raises `HostError` if it is not a parameter or input.
    """
    if not isinstance(fmu, NamedFmu) or name not in fmu.table:
        return None
    result = fmu.table[name]
    if result.may_be_set:
        return result
    raise HostError(f"{where}: '{name}' is not a parameter or input of the FMU; it cannot be set.")


@dataclass(frozen=True)
class PlannedRuns:
    """The FMU, points and jobs of a study."""

    fmu: SimulatedFmu
    """Under ALi3 names if there is an alias file."""
    source: FmuSource
    points: Points
    parameters: dict[str, Any]
    """A record of each parameter by its name."""
    jobs: list[Job]
    """Jobs at each point."""


def planned_runs(study: StudyFile, file: Path, opened: Fmu) -> PlannedRuns:
    """The runs of a study file. `file`: its path, to which paths in it are relative.

    Raises `HostError` if a parameter is unknown, a value is out of range (with its row), a grid is empty, or a
    manoeuvre overwrites a parameter.
    """
    source = fmu_source_of(study.aliases, file, opened)
    fmu: SimulatedFmu = source.seen(opened)
    points, parameters = _points(study, file, opened, fmu)
    return PlannedRuns(fmu, source, points, parameters, jobs_of(study, file, fmu, list(parameters)))


def runs_of_folder(folder: Path, record: dict[str, Any]) -> tuple[StudyFile, PlannedRuns]:
    """The study of a folder of results, and its runs. Raises `HostError` if the results are of another FMU."""
    study, _ = read_study_file(folder / "study.toml")
    with Fmu(fmu_of_folder(folder, record)) as opened:
        return study, planned_runs(study, Path(record["file"]), opened)


def _points(study: StudyFile, file: Path, opened: Fmu, fmu: SimulatedFmu) -> tuple[Points, dict[str, Any]]:
    """Points, and a record of each parameter."""

    def variable_of(name: str, where: str) -> Variable:
        return variable_by_ali3_name(fmu, name, where) or opened.table.settable(name, where)

    for name, value in study.start.items():
        variable_of(name, f"{file}: start").check(value, f"{file}: start")
    if study.sampling.method == "table":
        assert study.sampling.file is not None
        table = table_points(file.parent / study.sampling.file, variable_of, study.parameters)
        names = list(table.block(0, 0))
        duplicates = sorted(set(names) & set(study.start))
        if duplicates:
            raise HostError(
                f"{file}: '{duplicates[0]}' is a column of {study.sampling.file} and in [start]; give it once."
            )
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


@dataclass(frozen=True)
class Plan:
    """The checked plan of a study."""

    name: str
    file: Path
    fmu: Path
    work: Work
    points: Points
    outputs: tuple[str, ...]
    """Inputs and outputs of the FMU, which a run records."""
    record: dict[str, Any]
    """The plan for JSON; two plans with the same record are the same study."""
    notes: tuple[str, ...] = ()

    @property
    def runs(self) -> int:
        """Points times manoeuvres."""
        return self.points.count * len(self.work.jobs)

    @property
    def key(self) -> str:
        """The key of the study on workers."""
        return hashlib.sha256(json.dumps(self.record, sort_keys=True).encode()).hexdigest()[:16]

    def runs_at(self, indices: Sequence[int]) -> list[Run]:
        """Runs with their values. `indices`: rising."""
        jobs = len(self.work.jobs)
        first, last = indices[0] // jobs, indices[-1] // jobs
        block = self.points.block(first, last - first + 1)
        return [
            Run(index, {name: column[index // jobs - first] for name, column in block.items()}) for index in indices
        ]


def make_plan(study: StudyFile, file: Path, fmu_path: Path) -> Plan:
    """Check a study against its FMU. `file`: its path, to which paths in it are relative.

    Raises `HostError` if a parameter, signal or measure is unknown, a value is out of range (with its row), a grid is
    empty, or a manoeuvre overwrites a parameter.
    """
    content = read_bytes(fmu_path, LARGEST_ARCHIVE, HostError) if is_file(fmu_path) else b""
    with Fmu(fmu_path) as opened:
        runs = planned_runs(study, file, opened)
        fmu, points, parameters, jobs = runs.fmu, runs.points, runs.parameters, runs.jobs
        units = {n: v.unit or "1" for n, v in fmu.variables.items()}
        signals = _checked_signals(study, file, fmu)
        measures, columns = _checked_measures(
            study, file, fmu, units, [j.manoeuvre.stop_time for j in jobs if j.manoeuvre]
        )
        outputs = tuple(dict.fromkeys((*fmu.names("input"), *fmu.names("output"))))
        guid, model = opened.description.guid, opened.description.modelName
    _check_names(file, [*parameters, *columns])
    work = Work(
        runs.source,
        guid,
        hashlib.sha256(content).hexdigest(),
        program_digest(),
        tuple(jobs),
        tuple(parameters),
        tuple(measures),
        tuple(columns),
        tuple(signals),
        study.sampling.seed,
        time_limit=study.time_limit,
    )
    known_names = {name: units[name] for name in (*parameters, *signals)} | columns
    name = study.name or file.stem
    record = {
        "name": name,
        "guid": guid,
        "model": model,
        "fmu": fmu_path.name,
        "fmu_sha256": work.sha256,
        "seed": study.sampling.seed,
        "sampling": study.sampling.model_dump(),
        "parameters": {n: p.record() if isinstance(p, Parameter) else p for n, p in parameters.items()},
        "manoeuvres": [_job_record(entry, job) for entry, job in zip(study.manoeuvres, jobs, strict=True)],
        "start": study.start,
        "measures": dict(columns),
        "measured": {m.name: m.digest for m in measures},
        "signals": study.signals.model_dump() if study.signals else None,
        "aliases": runs.source.digest if study.aliases else None,
        "points": points.count,
        "runs": points.count * len(jobs),
        "points_sha256": digest(points),
        "units": {**known_names, "simulated": "s", "wall_seconds": "s", "time": "s"},
        "versions": versions(),
        "program": work.program,
        "file": str(file.absolute()),
    }
    return Plan(name, file, fmu_path, work, points, outputs, record, _notes_on(study))


def _job_record(entry: ManoeuvreEntry, job: Job) -> dict[str, Any]:
    entries = entry.model_dump(exclude_none=True)
    step = None if math.isnan(job.step) else job.step
    return {**entries, "name": job.label, "step": step, "sha256": job_digest(job)}


def job_digest(job: Job) -> str:
    """A hash of a job, with the tables and states of its manoeuvre."""
    manoeuvre_hash = "" if job.manoeuvre is None else manoeuvre_digest(job.manoeuvre)
    content = job.test, job.settings, job.start, job.step, job.every, job.samples, manoeuvre_hash
    return hashlib.sha256(repr(content).encode()).hexdigest()


def _checked_signals(study: StudyFile, file: Path, fmu: SimulatedFmu) -> list[str]:
    if study.signals is None:
        return []
    variables = [*fmu.names("input"), *fmu.names("output")]
    for k, name in enumerate(study.signals.names):
        if name not in variables:
            raise HostError(f"{file}: signals.names: {unknown_name_text(name, variables, 'input or output')}")
        if name in study.signals.names[:k]:
            raise HostError(f"{file}: signals.names has '{name}' twice; each is kept once.")
    return list(study.signals.names)


def unknown_name_text(name: str, known: Iterable[str], kind: str) -> str:
    """A sentence on an unknown name, with a similar one. `kind`: kind of the name."""
    return f"the FMU has no {kind} '{name}'{did_you_mean(name, known, 'the command check lists them')}"


def _checked_measures(
    study: StudyFile, file: Path, fmu: SimulatedFmu, units: Mapping[str, str], stop_times: Sequence[float]
) -> tuple[list[StudyMeasure], dict[str, str]]:
    """Measures of manoeuvres, and their columns with units. `stop_times`: stop times of the manoeuvres, s."""
    if study.measures and not stop_times:
        raise HostError(f"{file}: [measures] are of manoeuvres; this study has tests only, which have their own.")
    if not study.measures:
        return [], {}
    recorded = {n: units[n] for n in (*fmu.names("input"), *fmu.names("output"))}
    measures: list[StudyMeasure] = []
    columns: dict[str, str] = {}
    for name, text in study.measures.items():
        try:
            measure = parse_measure(text, name, file.parent)
            columns |= measure.columns(recorded, min(stop_times))
        except HostError as error:
            raise HostError(f"{file}: measures.{name}: {error}") from None
        measures.append(measure)
    return measures, columns


def _check_names(file: Path, names: Sequence[str]) -> None:
    for k, name in enumerate(names):
        if name in OWN_COLUMNS or name == ALL:
            raise HostError(f"{file}: '{name}' is a column that every table of a study has; give it another name.")
        if name in names[:k]:
            raise HostError(f"{file}: two columns of the table would be called '{name}'; give a measure another name.")


def _notes_on(study: StudyFile) -> tuple[str, ...]:
    notes = []
    n = study.sampling.runs or 1
    if study.sampling.method in ("sobol", "saltelli") and n & (n - 1):
        power = 1 << (n.bit_length() - 1)
        notes.append(f"Sobol' points are balanced at powers of two: {power} or {2 * power} would be better than {n}.")
    if not study.measures and study.signals is None and all(m.test is None for m in study.manoeuvres):
        notes.append("The study has neither measures nor signals: its table will only show which runs finished.")
    return tuple(notes)
