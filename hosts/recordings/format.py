"""Names in the folder of a recording."""

from __future__ import annotations

from pathlib import Path

FORMAT, VERSION = "ALi3 recording", 1

DESCRIPTION, EVENTS, STATE = "recording.json", "events.jsonl", "start.state"

RESTARTS = ("reset", "upright")
"""Kinds of events with which the FMU starts again."""

REWIND, REFUSED = "rewind", "refused"


def is_recording(path: Path) -> bool:
    """Whether a path is the folder of a recording."""
    return (path / DESCRIPTION).is_file()
