"""Names in the folder of a recording, and whether there is one."""

from pathlib import Path

from ali3.reading import is_file
from hosts.common.errors import HostError

FORMAT = "ALi3 recording"
VERSION = 2

DESCRIPTION = "recording.json"
EVENTS = "events.jsonl"
STATE = "start.state"
STATES = "states"

RESTARTS = ("reset", "upright")
"""Kinds of events with which the FMU starts again."""

REWIND = "rewind"
REFUSED = "refused"


def is_recording(path: Path) -> bool:
    """Whether a path is the folder of a recording."""
    return is_file(path / DESCRIPTION)


def check_new(folder: Path) -> None:
    """Refuse a folder that holds a recording already, also one that is being made."""
    if any((folder / name).exists() for name in (DESCRIPTION, EVENTS)):
        raise HostError(
            f"{folder} holds a recording already, or another program is recording there; name another folder."
        )
