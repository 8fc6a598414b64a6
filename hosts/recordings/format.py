"""Names in the folder of a recording."""

from __future__ import annotations

FORMAT, VERSION = "ALi3 recording", 1

DESCRIPTION, EVENTS, STATE = "recording.json", "events.jsonl", "start.state"

RESTARTS = ("reset", "upright")
"""Kinds of events with which the FMU starts anew."""

REWIND, REFUSED = "rewind", "refused"
