"""FMUs of a car without a flexible frame, built once."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path

import pytest
import tomli_w

from hosts.fmu.built_fmu import build_fmu
from mbs.vehicle import load


def _built(folder: Path, *options: str) -> None:
    data = copy.deepcopy(load("prototype")._data)
    del data["chassis"]["frame"]
    file = folder / "car.toml"
    file.write_text(tomli_w.dumps(data), encoding="utf-8")
    build_fmu("a rigid car", ("--car", str(file), *options), folder)


Made = Callable[[str, Callable[[Path], None]], Path]


@pytest.fixture(scope="session")
def rigid_fmu(prototype_fmu: Path) -> Path:
    """As it is driven."""
    return prototype_fmu


@pytest.fixture(scope="session")
def braked_fmu(made_once: Made) -> Path:
    """With ports of the brakes."""
    return made_once("rigid_car_brakes", lambda folder: _built(folder, "--ports", "brakes")) / "PrototypePorts.fmu"
