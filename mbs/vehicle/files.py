"""The files that a car file names lie in its folder."""

from __future__ import annotations

import os
from pathlib import Path

from mbs.vehicle.errors import CarFileError


def beside(folder: Path, name: str, key: str) -> Path:
    """A file of the car's folder.

    `name`: as the car file gives it; `key`: key path that gives it. Raises `CarFileError`: it lies elsewhere, or is not
    there.
    """
    if not name or "\0" in name or "\\" in name or Path(name).is_absolute() or ".." in Path(name).parts:
        raise CarFileError(
            f"{key} is {name!r}; it must be the name of a file in the folder of the car, without '..', '\\' or a drive."
        )
    path = folder / name
    if not os.path.lexists(path):
        raise CarFileError(f"{key} is {name!r}; there is no such file in {folder}.")
    if not path.resolve().is_relative_to(folder.resolve()):
        raise CarFileError(f"{key} is {name!r}; it leads out of the folder of the car.")
    return path
