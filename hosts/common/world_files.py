"""Worlds: road and drawing, made by ``ali3 road --world`` and kept in the cache of the user, and their records."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.cache import cache_folder
from ali3.json_reading import read_json
from ali3.reading import LARGEST_IN_PARTS, is_file, open_file
from hosts.common.commands import ERROR, run_ali3
from hosts.common.errors import HostError
from hosts.common.numbers import Value

DEFAULT_WORLD = "proving_ground"
_START = {"x": "initial.x", "y": "initial.y", "yaw": "initial.yaw"}
FORMAT = "ALi3 world"
VERSION = 1
_REMEDY = "make it again with: ali3 road --world NAME-or-FILE --out FOLDER."


def read_world_record(file: Path) -> dict[str, Any]:
    """Read the record of a world.

    Result: with ``name``, ``road``, ``bounds``, ``places``, ``roads`` and ``scenery``. Raises `HostError`: it cannot be
    read, or is not a world of this version.
    """
    content: dict[str, Any] = read_json(file, HostError)
    results = (content.get("format"), content.get("version")) if isinstance(content, dict) else (None, None)
    if results != (FORMAT, VERSION):
        raise HostError(f"{file} is not a world of version {VERSION}, which this version of ali3 reads; {_REMEDY}")
    return content


def world_beside(road: Path) -> dict[str, Any] | None:
    """The record of the world of a road file; None if there is no record of that name beside it.

    Raises `HostError`: it is a world that cannot be read, or that of another road file of that name.
    """
    file = road.with_suffix(".json")
    if not is_file(file):
        return None
    content = read_json(file, HostError)
    if not isinstance(content, dict) or content.get("format") != FORMAT or content.get("road") != road.name:
        return None
    if is_file(road) and content.get("checksum") not in (None, _checksum(road)):
        raise HostError(f"{file} is the record of another {road.name} than the one beside it; {_REMEDY}")
    return read_world_record(file)


def _checksum(road: Path) -> int:
    """The checksum in the header of a road file, which the record of its world repeats."""
    with open_file(road, LARGEST_IN_PARTS, HostError) as file:
        return int.from_bytes(file.read(16)[12:], "little")


@dataclass(frozen=True)
class World:
    """A world as the command writes it."""

    name: str
    road: Path | None
    """The road file; None: the FMU's own road."""
    content: Mapping[str, Any]
    """JSON: ``roads``, ``scenery``, ``places``, ``bounds``."""

    def places(self) -> dict[str, dict[str, Value]]:
        """Start values by name of the place."""
        return {p["name"]: {ours: float(p[key]) for key, ours in _START.items()} for p in self.content["places"]}

    def summary(self) -> dict[str, Any]:
        """The first message to a page; the drawing follows on request."""
        return {key: self.content[key] for key in ("name", "places", "bounds")}


def no_world(roads: list[Any]) -> World:
    """The FMU's own roads, without places and scenery."""
    content = {
        "format": FORMAT,
        "version": VERSION,
        "name": "",
        "places": [],
        "bounds": [-1e3, -1e3, 1e3, 1e3],
        "roads": roads,
        "scenery": [],
    }
    return World("", None, content)


def make_world(world: str, tell: Callable[[str], None] = lambda line: None, thin: bool = False) -> World:
    """A world by its name, or from a file.

    `world`: a name of the package, or a file that ``ali3 road --world`` takes; `tell`: called with lines of progress
    when it is made for the first time; `thin`: with few and rounded numbers, for a page. Raises `HostError`: it is not
    a world; with the message of ``ali3 road --world``.
    """
    file = Path(world)
    key = hashlib.sha256(str(file.absolute()).encode()).hexdigest()[:12] if is_file(file) else "named"
    folder = cache_folder("worlds", f"{key}-thin" if thin else key)

    def on_line(line: str) -> None:
        if line and not line.startswith(ERROR):  # which is raised
            tell(line)

    run_ali3("road", "--world", world, "--out", str(folder), *(["--thin"] if thin else []), on_line=on_line)
    # A description has a name of its own; the record of another one that stood in the file before is older.
    record = max(folder.glob("*.json"), key=lambda path: path.stat().st_mtime_ns) if is_file(file) else None
    content = read_world_record(record or folder / f"{file.stem}.json")
    return World(str(content["name"]), folder / content["road"], content)
