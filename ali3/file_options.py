"""Types of options that name a file: a fault of the file is one of the arguments, reported before any work."""

import argparse
from collections.abc import Callable
from pathlib import Path

from ali3.alias_file import alias_file, read_content
from ali3.errors import UserError
from ali3.files import check_writable
from ali3.message_text import brief
from ali3.read_parameter_set import read_parameter_set
from ali3.reading import LARGEST_IN_PARTS, check_file, is_file_or_folder, missing_file_text

MADE_OF = (".csv", ".txt", ".npy", ".npz", ".png", ".toml", ".crg", ".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
"""Suffixes of what ``ali3 road`` makes a road file of."""

Type = Callable[[str], Path]

_FILE_SUFFIXES = (
    *(".html", ".htm", ".csv", ".json", ".toml", ".ssv", ".fmu", ".ssp", ".zip", ".so", ".dll", ".dylib", ".wasm"),
    *(".png", ".svg", ".pdf", ".mp4", ".glb", ".gltf"),
)


def checked(check: Callable[[Path], object]) -> Type:
    """A path that passes a check, whose `UserError` becomes an `argparse.ArgumentTypeError`."""

    def path(text: str) -> Path:
        try:
            check(Path(text))
        except UserError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return Path(text)

    return path


def unless(word: str, checked_type: Type) -> Type:
    """The type of an option whose value is a file or this word."""
    return lambda text: Path(text) if text == word else checked_type(text)


def _check_exists(path: Path) -> None:
    if not is_file_or_folder(path):
        raise UserError(missing_file_text(path))


def _check_folder(path: Path) -> None:
    if path.suffix.lower() in _FILE_SUFFIXES:
        raise UserError(f"{path} is the name of a file; --out names the output folder")
    check_writable(path / ".lock")


input_file = checked(lambda path: check_file(path, LARGEST_IN_PARTS))
"""A regular file."""
input_path = checked(_check_exists)
"""A regular file or a folder."""
output_file = checked(check_writable)
"""A file that can be written."""
output_folder = checked(_check_folder)
"""A folder in which files can be written."""
aliases = checked(lambda path: read_content(alias_file(path)))
"""An alias file, or the name of one in the package."""
parameter_set = checked(read_parameter_set)
"""A parameter set."""


def road(text: str) -> str:
    """A road file here, the name of one in the FMU, or what ``ali3 road`` makes one of."""
    path = Path(text)
    suffix = path.suffix.lower()
    if suffix not in (".road", *MADE_OF):
        raise argparse.ArgumentTypeError(
            f"{brief(text)} is not read as a road; its suffix must be one of .road, {', '.join(MADE_OF)}"
        )
    is_name_in_fmu = suffix == ".road" and text == path.name and not is_file_or_folder(path)
    return text if is_name_in_fmu else str(input_file(text))
