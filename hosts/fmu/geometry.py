"""The drawing of an FMU: the scene in its resources, with roads read from their files."""

from collections.abc import Mapping
from pathlib import Path
from shlex import quote
from typing import Any

from ali3.archives import Archive
from ali3.json_reading import LARGEST_JSON, read_json
from ali3.processes import command_name
from ali3.reading import is_file
from ali3.scene.errors import SceneError
from ali3.scene.scene import read_scene
from ali3.temporary_folder import temporary_folder
from hosts.common.commands import run_ali3
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.world_record import world_beside
from hosts.fmu.description_file import opened

RESOURCE = "resources/geometry.json"
_ROADS = "resources/roads"


def scene_of(
    path: Path, settings: Mapping[str, Value] | None = None, world: str | None = None
) -> dict[str, Any] | None:
    """The scene of an FMU.

    `settings`: what was set in it: a road of a file is drawn from the file that its parameter names, that of a world
    with the scenery that its record beside the file has; `world`: the world that the road of a file was of; where its
    record is gone, `missing` says so. Result: None if the FMU has no scene, as those of other programs. Raises
    `HostError`: it is no FMU that can be read, or its scene is not of the format.
    """
    try:
        with opened(path) as fmu:
            if RESOURCE not in fmu:
                return None
            scene = read_scene(fmu.read(RESOURCE, LARGEST_JSON), f"{RESOURCE} of {path}")
            roads, missing, scenery = _roads(scene, fmu, settings or {}, world)
    except SceneError as error:
        raise HostError(str(error)) from None
    additions = {"scenery": [*scene.get("scenery", []), *scenery]} if scenery else {}
    return scene | {"roads": roads, "missing": [*scene.get("missing", []), *missing]} | additions


def _roads(
    scene: Mapping[str, Any], fmu: Archive, settings: Mapping[str, Value], expected: str | None
) -> tuple[list[Any], list[dict[str, str]], list[Any]]:
    """Roads with those of files read and with the values that were set; what cannot be drawn, and why; scenery."""
    roads, missing, scenery = list[Any](), list[dict[str, str]](), list[Any]()
    for road in scene.get("roads", []):
        variables = road.get("variables") or {}
        road_file = str(settings.get(variables.get("file", road.get("variable", "")), ""))
        name = road_file or str(road.get("path", "") if road["kind"] == "file" else "")
        if not name and road["kind"] != "file":
            roads.append(_set(road, settings))
        elif name:
            try:
                file = Path(name.removeprefix("file://"))
                world = world_beside(file)
                road_parts = [_part(name, fmu)] if world is None else world["roads"]
                if "friction_factor" in variables:
                    retained = {"variables": {"friction_factor": variables["friction_factor"]}}
                    road_parts = [_set({"friction_factor": 1.0} | part | retained, settings) for part in road_parts]
                roads += road_parts
                if world is None:
                    if road_file and expected:
                        why = f"{file.with_suffix('.json')} is not there; {_made_by(file)}"
                        missing.append({"name": f"The scenery of {expected}", "why": why})
                else:
                    scenery += world["scenery"]
            except HostError as error:
                missing.append({"name": f"The road {name}", "why": str(error).rstrip(".")})
    return roads, missing, scenery


def _set(road: dict[str, Any], settings: Mapping[str, Value]) -> dict[str, Any]:
    """A road as slick as the parameters have it, with its kerb where they do: the higher side stays where it is."""
    variables = road.get("variables") or {}
    frictions = {
        key: settings[variables[key]] for key in ("friction", "friction_factor") if variables.get(key) in settings
    }
    entry = road | {key: float(value) for key, value in frictions.items()}
    if road["kind"] != "profile" or len(road["heights"]) != 2:
        return entry
    if variables.get("kerb_x") in settings:
        entry["origin"] = [float(settings[variables["kerb_x"]]), *list(road.get("origin", (0.0, 0.0, 0.0)))[1:]]
    if variables.get("kerb_height") in settings:
        first, last = road["heights"][0], road["heights"][-1]
        high = max(first, last)
        low = high - float(settings[variables["kerb_height"]])
        # Where both sides were level, the kerb is one to drive down, as it is by default.
        entry["heights"] = [low, high] if first < last else [high, low]
    return entry


def _part(name: str, fmu: Archive) -> dict[str, Any]:
    """A road file as a part of a scene."""
    with temporary_folder() as folder:
        inside = next((n for n in (name, f"{_ROADS}/{name}") if n in fmu), None)
        file = Path(name.removeprefix("file://"))
        if inside is not None:
            file = Path(folder, Path(inside).name)
            file.write_bytes(fmu.read(inside))
        elif not is_file(file):
            remedy = f"; {_made_by(file)}" if file.is_absolute() else ""
            raise HostError(f"its file is not there{remedy}")
        out = Path(folder, "part.json")
        run_ali3("road", str(file), "--part", str(out))
        part: dict[str, Any] = read_json(out, HostError)
        return part


def _made_by(road: Path) -> str:
    """How the world of a road file is made again."""
    line = f"{command_name('road')} --world {quote(road.stem)} --out {quote(str(road.parent))}"
    return f"that of a world is made again by: {line}"
