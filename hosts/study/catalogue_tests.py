"""Tests of the catalogue in a study."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path

from hosts.catalogue.car import TestedCar
from hosts.catalogue.perform import perform, settings_of_test
from hosts.catalogue.record import TestRecord
from hosts.catalogue.registry import standard_test
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.aliases.alias import Aliases
from hosts.study.job import Job


def checked_test(name: str, given: Mapping[str, float], fmu: SimulatedFmu, where: str) -> tuple[str, dict[str, float]]:
    """Name and settings of a test, if it can be done with an FMU.

    `given`: settings that are not by default; `where`: how messages call where it is asked for. Raises `HostError`:
    there is no such test or setting, or the FMU lacks what it needs.
    """
    try:
        test = standard_test(name)
        settings = settings_of_test(test, given)
    except HostError as error:
        raise HostError(f"{where}: {error}") from None
    there = {*fmu.variables, *fmu.constants()}
    for need in test.needs:
        names = {name.strip() for name in need.split("|")}
        if not names & there:
            raise HostError(f"{where}: the test {test.name} needs {' or '.join(sorted(names))}, which the FMU has not.")
    return test.name, settings


def performed(
    job: Job,
    path: Path,
    name: str,
    names: Aliases,
    values: Mapping[str, Value],
    progress: Callable[[float], None] = lambda done: None,
) -> TestRecord:
    """What the test of a job has yielded. `name`: of the FMU in messages; `progress`: see `StandardTest.perform`."""
    step = None if math.isnan(job.step) else job.step
    car = TestedCar(name, path, names, {**job.start, **values}, step)
    return perform(standard_test(job.test), car, job.settings, progress)
