"""Decides whether a command-line argument names a car."""

from pathlib import Path

from ali3.reading import is_file, is_folder

CAR_FILE = "car.toml"


def is_car(path: Path) -> bool:
    """Whether a path names a car: a folder with a car file, a TOML file, or a plain name that is not a file."""
    if is_folder(path):
        return is_file(path / CAR_FILE)
    if is_file(path):
        return path.suffix.lower() == ".toml"
    return path.name.isidentifier() and str(path) == path.name
