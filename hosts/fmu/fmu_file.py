"""Finds the FMU of a command: a file, or the cached FMU of a car, built on demand."""

import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hosts.common.package_names import check_car
from hosts.fmu.built_fmu import fmu_of_car
from hosts.fmu.car import is_car

DIST = Path("dist", "PrototypeCar.fmu")
CAR = "prototype"
"""`DIST`, `CAR`: the FMU of a command without one: this file if it exists, otherwise the FMU of this car."""


@dataclass(frozen=True)
class FoundFmu:
    """An FMU and its source."""

    path: Path
    built: float = 0.0
    """Time of its build, s; 0: it existed."""


def find_fmu(fmu_or_car: Path | None, tell: Callable[[str], None]) -> FoundFmu:
    """The FMU of a command.

    `fmu_or_car`: an FMU, or a car by its name, folder or file; `tell`: called with the messages of the build of a
    car. Raises `HostError` with the message of the build if the car cannot be built.
    """
    if fmu_or_car is None and DIST.is_file():
        return FoundFmu(DIST)
    if fmu_or_car is not None and not is_car(fmu_or_car):
        return FoundFmu(fmu_or_car)
    if fmu_or_car is not None:
        check_car(fmu_or_car)
    begin = time.monotonic()
    messages: list[str] = []

    def collect(line: str) -> None:
        messages.append(line)
        tell(line)

    path = fmu_of_car(CAR if fmu_or_car is None else str(fmu_or_car), collect)
    return FoundFmu(path, time.monotonic() - begin if messages else 0.0)


def fmu_file(fmu_or_car: Path | None) -> Path:
    """The path of the FMU of a command; messages of its build are printed. See `find_fmu`."""
    return find_fmu(fmu_or_car, lambda line: print(line, flush=True)).path


def snake_case(name: str) -> str:
    """The file name of an FMU in lower case with underscores, as scenes, cars and result files are named."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
