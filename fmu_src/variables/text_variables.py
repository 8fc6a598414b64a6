"""Variables of type String: the files of roads."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.archives import LARGEST_UNPACKED
from ali3.reading import read_bytes
from fmu_src.variables.variables import Variable
from mbs.roads.package_roads import FOLDER

ROADS = "resources/roads"
"""Folder of the files of roads in an FMU."""


@dataclass(frozen=True)
class TextVariable:
    """A fixed parameter that is text. Its value reference comes after those of all other variables."""

    name: str
    description: str
    road: int
    """The road whose file it names."""
    start: str
    """Name of a file in `ROADS`; empty: none."""


def text_table(meta: Mapping[str, Any], table: Sequence[Variable]) -> tuple[TextVariable, ...]:
    """The text variables of a System. Raises `ValueError`: a name is taken."""
    names = {v.name for v in table}
    variables = []
    for entry in meta.get("road_files", ()):
        if entry["name"] in names:
            raise ValueError(f"Two variables are named '{entry['name']}'; every one needs its own name.")
        start = Path(entry["start"]).name
        variables.append(TextVariable(entry["name"], entry["description"], entry["road"], start))
    return tuple(variables)


def road_resources(meta: Mapping[str, Any]) -> dict[str, bytes]:
    """Files in `ROADS`, by their paths in the FMU: the roads of the package and those the model starts on.

    Empty if no road of the model is read from a file. Raises `ValueError`: two different roads have the same name.
    """
    files = meta.get("road_files", ())
    if not files:
        return {}
    roads = {path.name: read_bytes(path, LARGEST_UNPACKED) for path in sorted(FOLDER.glob("*.road"))}
    for entry in files:
        if entry["start"]:
            name, content = Path(entry["start"]).name, read_bytes(entry["start"], LARGEST_UNPACKED)
            if roads.setdefault(name, content) != content:
                raise ValueError(f"Two different roads are named '{name}'; rename {entry['start']}.")
    return {f"{ROADS}/{name}": content for name, content in roads.items()}
