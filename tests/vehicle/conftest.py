"""Folders with copies of the cars of the package."""

import shutil

import pytest

from mbs.vehicle.read_car import CARS


@pytest.fixture
def copied(tmp_path):
    """A function that copies a car of the package and gives its file."""

    def copy(name="prototype"):
        folder = tmp_path / name
        shutil.copytree(CARS / name, folder)
        return folder / "car.toml"

    return copy
