"""Finds the FMU of a command: a given file, or that of a car, which is built when needed and cached."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hosts.common.package_names import check_car
from hosts.fmu.built_fmu import fmu_of_car
from hosts.fmu.car import is_car

DIST = Path("dist", "PrototypeCar.fmu")
CAR = "prototype"
"""What is taken where nothing is named: `DIST` if it is there, else this car."""


@dataclass(frozen=True)
class FoundFmu:
    """An FMU and its source."""

    path: Path
    built: float = 0.0
    """Seconds that its build took; 0: it was there."""


def find_fmu(fmu_or_car: Path | None, tell: Callable[[str], None]) -> FoundFmu:
    """The FMU that a command takes.

    `fmu_or_car`: of the command line: an FMU; or a car by its name, its folder or its file; `tell`: takes the messages
    of the build of a car. Raises `HostError`: the car cannot be built; with the message of the build.
    """
    if fmu_or_car is None and DIST.is_file():
        return FoundFmu(DIST)
    if fmu_or_car is not None and not is_car(fmu_or_car):
        return FoundFmu(fmu_or_car)
    if fmu_or_car is not None:
        check_car(fmu_or_car)
    begin = time.monotonic()
    built: list[str] = []

    def said(line: str) -> None:
        built.append(line)
        tell(line)

    path = fmu_of_car(CAR if fmu_or_car is None else str(fmu_or_car), said)
    return FoundFmu(path, time.monotonic() - begin if built else 0.0)


def fmu_file(fmu_or_car: Path | None) -> Path:
    """`find_fmu` for a command that prints what is said."""
    return find_fmu(fmu_or_car, lambda line: print(line, flush=True)).path
