"""A manoeuvre by name, by file or by the folder of a recording."""

from dataclasses import replace
from pathlib import Path

from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_file import check_manoeuvre, read_manoeuvre
from hosts.recordings.format import is_recording
from hosts.recordings.last_drive import recorded_manoeuvre


def load_manoeuvre(manoeuvre: str, stop_time: float | None = None) -> Manoeuvre:
    """Read a manoeuvre by name or path; a folder that holds a recording of the simulator is its last drive.

    `manoeuvre`: see `hosts.driving.manoeuvre_file.read_manoeuvre`; `stop_time`: in place of its own, s. Raises
    `HostError` with the line and the reason.
    """
    if not is_recording(Path(manoeuvre)):
        return read_manoeuvre(manoeuvre, stop_time)
    made = recorded_manoeuvre(Path(manoeuvre))
    return made if stop_time is None else replace(made, stop_time=stop_time)


def check_asked(given: str | None) -> None:
    """Refuse a word that is not a manoeuvre, before an FMU is built for it. `given`: as of `load_manoeuvre`, if any."""
    if given is not None and not is_recording(Path(given)):
        check_manoeuvre(given)
