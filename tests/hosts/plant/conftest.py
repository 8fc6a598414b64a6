"""FMUs of a car without a flexible frame, built once."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.in_process import build_fmu
from tests.vehicle.rigid_car import rigid_car


def _built(folder: Path, *options: str) -> None:
    file = rigid_car("prototype", folder / "source")
    build_fmu(folder, "--car", str(file), *options)


Made = Callable[[str, Callable[[Path], None]], Path]


@pytest.fixture(scope="session")
def rigid_fmu(prototype_fmu: Path) -> Path:
    """The FMU without ports."""
    return prototype_fmu


@pytest.fixture(scope="session")
def braked_fmu(made_once: Made) -> Path:
    """The FMU with ports of the brakes."""
    return made_once("rigid_car_brakes", lambda folder: _built(folder, "--ports", "brakes")) / "PrototypePorts.fmu"
