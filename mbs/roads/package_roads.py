"""Road files of the package."""

import os
from pathlib import Path

from ali3.reading import is_file_or_folder

FOLDER = Path(__file__).with_name("files")


def road_path(value: str | os.PathLike[str]) -> str:
    """Path of a road file: the path itself, or the road of the package with that name if there is no such file."""
    text = os.fspath(value)
    in_package = text in {path.name for path in FOLDER.glob("*.road")}
    return str(FOLDER / text) if in_package and not is_file_or_folder(text) else text
