"""The prototype car of this platform, built once for all tests of the catalogue."""

from __future__ import annotations

from pathlib import Path

import fmpy
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from hosts.catalogue.car import TestedCar


@pytest.fixture(scope="session")
def prototype_fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    name, system = load_scene("prototype_car")
    return build_fmu(system, name, tmp_path_factory.mktemp("prototype"), [fmpy.platform])


@pytest.fixture(scope="session")
def prototype(prototype_fmu: Path) -> TestedCar:
    return TestedCar("prototype", prototype_fmu)
