"""Worlds: road and drawing, made by the command ``ali3 world`` and kept in the cache of the user."""

from __future__ import annotations

import hashlib
import json
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.cache import cache_folder
from ali3.running import module_command
from hosts.common.errors import HostError
from hosts.common.numbers import Value

DEFAULT_WORLD = "proving_ground"
_COMMAND = "mbs.worlds.command"
_GOING_ON = "..."
_FORMAT = ("ALi3 world", 1)
_START = {"x": "initial.x", "y": "initial.y", "yaw": "initial.yaw"}


@dataclass(frozen=True)
class World:
    """A world as the command writes it.

    Parameters
    ----------
    name : str
    road : Path or None
        The road file; None: the FMU's own road.
    content : mapping
        JSON: ``roads``, ``scenery``, ``places``, ``bounds``.
    """

    name: str
    road: Path | None
    content: Mapping[str, Any]

    def places(self) -> dict[str, dict[str, Value]]:
        """Start values by name of the place."""
        return {p["name"]: {ours: float(p[key]) for key, ours in _START.items()} for p in self.content["places"]}

    def for_hello(self) -> dict[str, Any]:
        """What a page is told first; the drawing follows when it asks."""
        return {key: self.content[key] for key in ("name", "places", "bounds")}


def no_world(roads: list[Any]) -> World:
    """The FMU's own roads, without places and scenery."""
    content = {
        "format": _FORMAT[0],
        "version": _FORMAT[1],
        "name": "",
        "places": [],
        "bounds": [-1e3, -1e3, 1e3, 1e3],
        "roads": roads,
        "scenery": [],
    }
    return World("", None, content)


def make_world(given: str, tell: Callable[[str], None]) -> World:
    """A world by its name, or from a file.

    Parameters
    ----------
    given : str
        A name of the package, or a file that ``ali3 world`` takes.
    tell : callable
        Takes lines that say how far it is, where it is made for the first time.

    Raises
    ------
    HostError
        It is none; with the words of ``ali3 world``.
    """
    file = Path(given)
    room = hashlib.sha256(str(file.absolute()).encode()).hexdigest()[:12] if file.is_file() else "named"
    folder = cache_folder("worlds", room)
    command = module_command(_COMMAND, given, "--out", str(folder))
    last = ""
    with subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, encoding="utf-8"
    ) as running:
        assert running.stderr is not None
        for line in running.stderr:
            last = line.strip() or last
            if last.endswith(_GOING_ON):
                tell(last)
    if running.returncode != 0:
        raise HostError(last.removeprefix("error: ") or f"{given} is no world.")
    content = json.loads((folder / f"{file.stem}.json").read_text(encoding="utf-8"))
    if (content.get("format"), content.get("version")) != _FORMAT:
        raise HostError(f"{folder / file.stem}.json is no world of version {_FORMAT[1]}; remove it and start again.")
    return World(str(content["name"]), folder / content["road"], content)
