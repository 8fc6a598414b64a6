"""Decides whether a command-line argument names a car."""

from pathlib import Path

from ali3.reading import is_file, is_folder

CAR_FILE = "car.toml"


def is_car(car: Path) -> bool:
    """Whether a car is meant: a folder with a car file, a TOML file, or a name that is none of a file here."""
    if is_folder(car):
        return is_file(car / CAR_FILE)
    if is_file(car):
        return car.suffix.lower() == ".toml"
    return car.name.isidentifier() and str(car) == car.name
