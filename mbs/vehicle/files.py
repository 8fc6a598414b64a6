"""The files that a car file names lie in its folder."""

from pathlib import Path

from ali3.named_files import NamedFiles
from ali3.reading import LARGEST_IN_PARTS
from mbs.vehicle.errors import CarFileError


def beside(folder: Path, name: str, key: str) -> Path:
    """A file of the car's folder.

    `name`: as the car file gives it; `key`: key path that gives it. Raises `CarFileError`: it lies elsewhere, or is no
    regular file.
    """
    if not name or "\0" in name or "\\" in name or Path(name).is_absolute() or ".." in Path(name).parts:
        raise CarFileError(
            f"{key} is {name!r}; it must be the name of a file in the folder of the car, without '..', '\\' or a drive."
        )
    return NamedFiles(folder, LARGEST_IN_PARTS, CarFileError).file(name, folder, key)
