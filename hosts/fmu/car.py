"""Whether a word of the command line names a car."""

from __future__ import annotations

from pathlib import Path

CAR_FILE = "car.toml"


def is_car(given: Path) -> bool:
    """Whether a car is meant: a folder with a car file, a TOML file, or a name that is none of a file here."""
    if given.is_dir():
        return (given / CAR_FILE).is_file()
    if given.is_file():
        return given.suffix.lower() == ".toml"
    return given.name.isidentifier() and str(given) == given.name
