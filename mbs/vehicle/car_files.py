"""Files beside a car file, which it names."""

from pathlib import Path

from ali3.named_files import NamedFiles
from ali3.reading import LARGEST_IN_PARTS
from mbs.vehicle.errors import CarFileError


def car_file_path(folder: Path, name: str, key: str) -> Path:
    """Path of a file in the car's folder or below it.

    `name`: value in the car file; `key`: its key path. Raises `CarFileError` if the file is not in the folder or is
    not a regular file.
    """
    if not _is_inner_path(name):
        raise CarFileError(
            f"{key} is {name!r}; it must be the path of a file in the folder of the car, without '..', '\\' or a drive."
        )
    return NamedFiles(folder, LARGEST_IN_PARTS, CarFileError).file(name, folder, key)


def _is_inner_path(name: str) -> bool:
    """Whether a name is a relative path without steps upwards, valid on every platform."""
    path = Path(name)
    return bool(name) and "\0" not in name and "\\" not in name and not path.is_absolute() and ".." not in path.parts
