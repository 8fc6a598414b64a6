"""The JSON file with the drawing of a world, which ``ali3 road --world`` writes beside its road."""

from pathlib import Path
from typing import Any

from ali3.json_reading import read_json
from ali3.reading import LARGEST_IN_PARTS, is_file, open_file
from hosts.common.errors import HostError

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
