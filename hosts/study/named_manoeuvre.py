"""The manoeuvre that a study names: one of the package, a file or a recording."""

from __future__ import annotations

from pathlib import Path

from ali3.near_names import did_you_mean
from ali3.reading import is_folder
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_file import SUFFIXES
from hosts.driving.manoeuvres import manoeuvre_names
from hosts.recordings.load_manoeuvre import load_manoeuvre


def named_manoeuvre(name: str, file: Path) -> Manoeuvre:
    """A manoeuvre of the package by its name, else a file beside the study; `HostError` where there is neither."""
    known = manoeuvre_names()
    if name in known:
        return load_manoeuvre(name)
    if Path(name).suffix not in SUFFIXES and not is_folder(file.parent / name):
        hint = did_you_mean(name, known, f"known are {', '.join(known)}, or a TOML or CSV file")
        raise HostError(f"{file}: there is no manoeuvre '{name}'{hint}")
    return load_manoeuvre(str(file.parent / name))
