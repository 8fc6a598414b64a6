"""The proving ground, made once: from the cache of the user where it was made before by the same code."""

import json
from types import SimpleNamespace

import pytest

from mbs.worlds.command import main
from mbs.worlds.package_worlds import WORLDS


@pytest.fixture(scope="session")
def proving_ground(made_once):
    """Path of its road file, and its record."""
    assert WORLDS.is_dir()

    def fill(folder):
        assert main(["--world", "proving_ground", "--out", str(folder)]) == 0

    out = made_once("proving_ground", fill)
    record = json.loads((out / "proving_ground.json").read_text(encoding="utf-8"))
    return SimpleNamespace(road=out / "proving_ground.road", record=record, json=out / "proving_ground.json")
