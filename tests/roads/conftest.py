"""The car that drives over roads."""

import pytest

import mbs
from mbs.scenes import prototype_car


@pytest.fixture(scope="session")
def car() -> mbs.System:
    """The prototype."""
    return mbs.compile(prototype_car.build())
