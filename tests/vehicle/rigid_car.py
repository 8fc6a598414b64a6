"""Cars of the package without their flexible frame: their FMUs are built in a third of the time."""

import shutil
import tomllib
from pathlib import Path
from typing import Any

import tomli_w

from mbs.vehicle.read_car import CARS


def rigid_car(name: str, folder: Path, **tables: Any) -> Path:
    """The file of a car in a copy of its folder, with other tables at its top."""
    shutil.copytree(CARS / name, folder)
    file = folder / "car.toml"
    data = tomllib.loads(file.read_text(encoding="utf-8"))
    data["chassis"].pop("frame", None)
    file.write_text(tomli_w.dumps(data | tables), encoding="utf-8")
    return file
