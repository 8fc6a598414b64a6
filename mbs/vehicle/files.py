"""Paths of the files that a car file names."""

from pathlib import Path

from ali3.named_files import NamedFiles
from ali3.reading import LARGEST_IN_PARTS
from mbs.vehicle.errors import CarFileError


def beside(folder: Path, name: str, key: str) -> Path:
    """Path of a file in the car's folder.

    `name`: value in the car file; `key`: its key path. Raises `CarFileError` if the file is not in the folder or not
    a regular file.
    """
    if not name or "\0" in name or "\\" in name or Path(name).is_absolute() or ".." in Path(name).parts:
        raise CarFileError(
            f"{key} is {name!r}; it must be the name of a file in the folder of the car, without '..', '\\' or a drive."
        )
    return NamedFiles(folder, LARGEST_IN_PARTS, CarFileError).file(name, folder, key)
