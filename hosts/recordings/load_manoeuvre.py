"""A manoeuvre by name, by file or by the folder of a recording."""

from __future__ import annotations

from pathlib import Path

from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.recordings.format import is_recording


def load_manoeuvre(manoeuvre: str) -> Manoeuvre:
    """Read a manoeuvre by name or path; a folder that holds a recording of the simulator is its last drive.

    `manoeuvre`: see `hosts.driving.manoeuvre_file.read_manoeuvre`. Raises `HostError` with the line and the reason.
    """
    if not is_recording(Path(manoeuvre)):
        return read_manoeuvre(manoeuvre)
    from hosts.recordings.last_drive import recorded_manoeuvre

    return recorded_manoeuvre(Path(manoeuvre))
