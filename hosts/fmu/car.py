"""Decides whether a command-line argument names a car."""

from pathlib import Path

from ali3.reading import is_file, is_folder

CAR_FILE = "car.toml"


def is_car(given: Path) -> bool:
    """Whether a car is meant: a folder with a car file, a TOML file, or a name that is none of a file here."""
    if is_folder(given):
        return is_file(given / CAR_FILE)
    if is_file(given):
        return given.suffix.lower() == ".toml"
    return given.name.isidentifier() and str(given) == given.name
