"""The prototype car as the catalogue tests it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hosts.catalogue.car import TestedCar


@pytest.fixture(scope="session")
def prototype(prototype_fmu: Path) -> TestedCar:
    return TestedCar("prototype", prototype_fmu)
