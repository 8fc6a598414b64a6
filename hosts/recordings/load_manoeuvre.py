"""A manoeuvre by name, by file or by the folder of a recording."""

from __future__ import annotations

from pathlib import Path

from hosts.driving.manoeuvre import Manoeuvre, read_manoeuvre
from hosts.recordings.last_drive import recorded_manoeuvre
from hosts.recordings.recorded_drive import is_recording, read_recording


def load_manoeuvre(manoeuvre: str) -> Manoeuvre:
    """Read a manoeuvre by name or path; a folder that holds a recording of the simulator is its last drive.

    Parameters
    ----------
    manoeuvre : str
        See `hosts.driving.manoeuvre.read_manoeuvre`.

    Raises
    ------
    HostError
        With the line and the reason.
    """
    folder = Path(manoeuvre)
    return recorded_manoeuvre(read_recording(folder)) if is_recording(folder) else read_manoeuvre(manoeuvre)
