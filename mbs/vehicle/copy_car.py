"""Copies a car of the package, with the JSON Schema of its file, so that it can be changed."""

import shutil
from pathlib import Path

from ali3.folders import atomic_folder
from ali3.near_names import did_you_mean
from mbs.common.checks import shown
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.read_car import CARS, FILE, car_names
from mbs.vehicle.schema import SCHEMA_FILE


def copy_car(name: str, folder: Path) -> list[Path]:
    """Copy the folder of a car, completely or not at all.

    Raises `CarFileError` if there is no such car, or the folder exists, and `FileError` if it
    cannot be written.
    """
    if name not in car_names():
        suggestion = did_you_mean(name, car_names(), f"the cars of the package are {', '.join(car_names())}", 1)
        raise CarFileError(f"There is no car {shown(name)} to copy{suggestion}")
    if folder.exists() or folder.is_symlink():
        raise CarFileError(f"{folder} exists; the copy of a car needs a folder that does not.")
    with atomic_folder(folder) as target:
        shutil.copytree(CARS / name, target, ignore=shutil.ignore_patterns("__pycache__"), dirs_exist_ok=True)
        shutil.copy(SCHEMA_FILE, target)
        file = target / FILE
        file.write_text(f"#:schema {SCHEMA_FILE.name}\n" + file.read_text(encoding="utf-8"), encoding="utf-8")
    return sorted(path for path in folder.rglob("*") if path.is_file())
