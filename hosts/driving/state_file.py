"""Saved states of an FMU as files beside manoeuvres."""

from pathlib import Path

from ali3.files import write_bytes
from ali3.named_files import NamedFiles
from ali3.reading import LARGEST_STATE, read_bytes
from hosts.common.errors import HostError


def read_state(folder: Path, name: str, where: str) -> bytes:
    """Read the saved state of an FMU. `name`: below the folder; `where`: of the name, for messages.

    Raises `HostError`: the file is outside of the folder, or cannot be read.
    """
    file = NamedFiles(folder, LARGEST_STATE, HostError).file(name, folder, f"{where}: the state")
    return read_bytes(file, LARGEST_STATE, HostError, f"{where}: the state {file}")


def write_state(state: bytes, file: Path) -> Path:
    """Write a saved state beside a file; the path of the state."""
    beside = file.with_suffix(".state")
    write_bytes(beside, state)
    return beside
