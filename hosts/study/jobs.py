"""The jobs at each point of a study: manoeuvres and tests of the catalogue, checked."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ali3.near_names import did_you_mean
from ali3.reading import is_folder
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform, settings_of_test, unmet_needs
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard_test import TestRecord
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.manoeuvre_file import SUFFIXES
from hosts.driving.manoeuvres import manoeuvre_names
from hosts.driving.pilots.pilot import ACTS
from hosts.driving.run_checks import check_columns, communication_step, steps_of
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.fmu_source import FmuSource
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.study.study_file import ManoeuvreEntry, StudyFile


@dataclass(frozen=True)
class Job:
    """A manoeuvre, or a test of the catalogue, that is run at each point."""

    label: str
    manoeuvre: Manoeuvre | None
    """With all start values but the parameters; None: a test."""
    test: str = ""
    """Name of the test; empty: a manoeuvre."""
    settings: dict[str, float] = field(default_factory=dict)
    measures: tuple[str, ...] = ()
    """Measures of the test; empty: all."""
    start: dict[str, Value] = field(default_factory=dict)
    step: float = float("nan")
    """Communication step, s; NaN for a test that takes the step of the FMU."""
    every: int = 0
    """Steps between stored values of signals; 0: none are stored."""
    samples: int = 0
    """Number of stored values of a signal."""


def named_manoeuvre(name: str, file: Path) -> Manoeuvre:
    """A manoeuvre of the package, otherwise of a file beside the study file. Raises `HostError` if there is neither."""
    names = manoeuvre_names()
    if name in names:
        return load_manoeuvre(name)
    if Path(name).suffix not in SUFFIXES and not is_folder(file.parent / name):
        hint = did_you_mean(name, names, f"known are {', '.join(names)}, or a TOML or CSV file")
        raise HostError(f"{file}: there is no manoeuvre '{name}'{hint}")
    return load_manoeuvre(str(file.parent / name))


def checked_test(
    name: str, set_values: Mapping[str, float], fmu: SimulatedFmu, where: str
) -> tuple[str, dict[str, float]]:
    """Name and settings of a test that can be done with an FMU.

    `set_values`: settings other than the defaults; `where`: name of the entry in messages. Raises `HostError` if there
    is no such test or setting, or the FMU lacks a variable that the test needs.
    """
    try:
        test = standard_test(name)
        settings = settings_of_test(test, set_values)
    except HostError as error:
        raise HostError(f"{where}: {error}") from None
    for need in unmet_needs(test, {*fmu.variables, *fmu.constants()}):
        raise HostError(
            f"{where}: the test {test.name} needs {need.replace(' | ', ' or ')}, which the FMU does not have."
        )
    return test.name, settings


def perform_test(job: Job, name: str, fmu: FmuSource, values: Mapping[str, Value]) -> TestRecord:
    """Run the test of a job. `name`: name of the FMU in messages; `values`: values of the parameters."""
    step = None if math.isnan(job.step) else job.step
    car = TestedCar(name, fmu, {**job.start, **values}, step)
    return perform(standard_test(job.test), car, job.settings)


def jobs_of(study: StudyFile, file: Path, fmu: SimulatedFmu, parameters: Sequence[str]) -> list[Job]:
    """The jobs at each point. `parameters`: those that the study varies.

    Raises `HostError` if a manoeuvre cannot be driven with this FMU, or overwrites a parameter.
    """
    jobs: list[Job] = []
    for number, entry in enumerate(study.manoeuvres, start=1):
        where = f"{file}: manoeuvres[{number}]"
        job = (
            _test_job(entry, study, fmu, where)
            if entry.test is not None
            else _manoeuvre_job(entry, study, file, fmu, where)
        )
        for earlier in jobs:
            if earlier.label == job.label:
                raise HostError(f"{where}: another manoeuvre is called '{job.label}'; give one of them another name.")
        if job.manoeuvre is not None:
            _check_parameters(job.manoeuvre, parameters, where)
        duplicates = sorted(set(entry.start) & set(parameters))
        if duplicates:
            raise HostError(f"{where}.start sets '{duplicates[0]}', which is a parameter of the study; give it once.")
        jobs.append(job)
    if study.signals is not None and all(job.manoeuvre is None for job in jobs):
        raise HostError(f"{file}: [signals] are of manoeuvres; this study has tests only, which keep none.")
    return jobs


def _manoeuvre_job(entry: ManoeuvreEntry, study: StudyFile, file: Path, fmu: SimulatedFmu, where: str) -> Job:
    if entry.manoeuvre is None:
        assert entry.stop_time is not None
        manoeuvre = Manoeuvre(entry.name or "run", np.zeros(0), {}, entry.stop_time)
    else:
        manoeuvre = named_manoeuvre(entry.manoeuvre, file)
        if entry.stop_time is not None:
            manoeuvre = replace(manoeuvre, stop_time=entry.stop_time)
    manoeuvre = with_names_of(manoeuvre, fmu.variables)
    try:
        check_columns(fmu, manoeuvre)
        if manoeuvre.driver:
            driver_of(fmu, manoeuvre)
        step = communication_step(fmu, manoeuvre, study.step)
    except HostError as error:
        raise HostError(f"{where}: {error}") from None
    start = {
        **manoeuvre.start,
        **_checked_start(study.start, fmu, ""),
        **_checked_start(entry.start, fmu, f"{where}.start"),
    }
    manoeuvre = replace(manoeuvre, name=entry.name or manoeuvre.name, start=start)
    every, samples = _sampling_of_signals(study, manoeuvre.stop_time, step, where)
    return Job(manoeuvre.name, manoeuvre, step=step, every=every, samples=samples)


def _test_job(entry: ManoeuvreEntry, study: StudyFile, fmu: SimulatedFmu, where: str) -> Job:
    assert entry.test is not None
    test, settings = checked_test(entry.test, entry.settings, fmu, where)
    start = {**study.start, **_checked_start(entry.start, fmu, f"{where}.start")}
    step = float("nan") if study.step is None else study.step
    return Job(entry.name or test, None, test, settings, tuple(entry.measures or ()), start, step)


def _checked_start(values: Mapping[str, Value], fmu: SimulatedFmu, where: str) -> dict[str, Value]:
    for name in values:
        if name not in fmu.variables:
            raise HostError(f"{where}: the FMU has no '{name}'{did_you_mean(name, fmu.variables)}")
    return {name: fmu.table[name].check(value, where) for name, value in values.items()}


def _check_parameters(manoeuvre: Manoeuvre, parameters: Sequence[str], where: str) -> None:
    for name in parameters:
        if name in manoeuvre.inputs:
            raise HostError(
                f"{where}: '{name}' is varied by the study and is a column of the manoeuvre; remove one of them."
            )
        if manoeuvre.driver and name in ACTS:
            raise HostError(f"{where}: '{name}' is a parameter of the study; the driver of the manoeuvre acts on it.")


def _sampling_of_signals(study: StudyFile, stop: float, step: float, where: str) -> tuple[int, int]:
    """Steps between stored values of signals, and the number of values. `stop`, `step`: s."""
    if study.signals is None:
        return 0, 0
    every = steps_of(study.signals.interval, step, f"{where}: signals.interval")
    return every, max(1, round(stop / step)) // every + 1
