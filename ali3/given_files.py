"""Checks the files that options name, before a command begins its work."""

import argparse
from collections.abc import Callable
from pathlib import Path

from ali3.alias_file import alias_file
from ali3.errors import UserError
from ali3.files import check_folder, check_writable
from ali3.read_parameter_set import read_parameter_set
from ali3.reading import LARGEST_IN_PARTS, check_file, is_file_or_folder, missing_file_text

MADE_OF = (".csv", ".txt", ".npy", ".npz", ".png", ".toml", ".crg", ".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
"""Suffixes of what ``ali3 road`` makes a road file of."""
_WORDS = {"aliases": "none", "variant": "as-is"}  # of an option of several files, in place of one


def check_given_files(options: argparse.Namespace) -> None:
    """Check the files of all options of a command line that name one. Raises `UserError` on the first fault."""
    for name, value in vars(options).items():
        if name not in _CHECKS or value is None:
            continue
        for file in value if isinstance(value, list) else [value]:
            if not (isinstance(value, list) and str(file) == _WORDS.get(name)):
                _CHECKS[name](Path(file))


def _check_input(file: Path) -> None:
    check_file(file, LARGEST_IN_PARTS)


def _check_input_or_folder(path: Path) -> None:
    if not is_file_or_folder(path):
        raise UserError(missing_file_text(path))


def _check_aliases(file: Path) -> None:
    _check_input(alias_file(file))


def _check_road(road: Path) -> None:
    suffix = road.suffix.lower()
    if suffix not in (".road", *MADE_OF):
        raise UserError(
            f"The road {road} cannot be used: {road} is not read as a road; its suffix must be one of .road, "
            f"{', '.join(MADE_OF)}."
        )
    if suffix != ".road" or len(road.parts) > 1:  # a name alone may be that of a road in the FMU
        _check_input(road)


_CHECKS: dict[str, Callable[[Path], object]] = {
    **dict.fromkeys(("log", "limits", "log_aliases"), _check_input),
    **dict.fromkeys(("reference", "geometry"), _check_input_or_folder),
    "aliases": _check_aliases,
    **dict.fromkeys(("parameters", "variant", "diff"), read_parameter_set),
    "road": _check_road,
    **dict.fromkeys(("json", "picture", "png", "mp4", "gltf", "junit", "sarif", "save_parameters"), check_writable),
    **dict.fromkeys(("out", "record"), check_folder),
}
