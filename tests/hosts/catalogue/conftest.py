"""The prototype car as the catalogue tests it."""

from pathlib import Path

import pytest

from hosts.catalogue.car import TestedCar
from hosts.fmu.fmu_source import FmuSource


@pytest.fixture(scope="session")
def prototype(prototype_fmu: Path) -> TestedCar:
    return TestedCar("prototype", FmuSource(prototype_fmu))
