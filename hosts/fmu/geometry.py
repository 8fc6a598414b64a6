"""The drawing of an FMU: the scene in its resources, with roads read from their files."""

from collections.abc import Mapping
from pathlib import Path
from shlex import quote
from typing import Any

from ali3.archives import Archive, is_archive
from ali3.json_reading import LARGEST_JSON, read_json
from ali3.processes import command_name
from ali3.reading import is_file, missing_file_text
from ali3.scene.errors import SceneError
from ali3.scene.scene import read_scene
from ali3.temporary_folder import temporary_folder
from hosts.common.commands import run_ali3
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.world_files import world_beside
from hosts.fmu.description_file import opened

RESOURCE = "resources/geometry.json"
_ROADS = "resources/roads"


def scene_of(
    path: Path, settings: Mapping[str, Value] | None = None, world: str | None = None
) -> dict[str, Any] | None:
    """The scene of an FMU.

    `settings`: parameters that were set: a road file is drawn from the file that its parameter names, with the scenery
    of the world whose record lies beside it; `world`: the world of the road file, named in `missing` where its record
    does not exist. Returns None if the FMU has no scene, as FMUs of other programs. Raises `HostError` if the FMU
    cannot be read, or its scene has another format.
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
    scene: Mapping[str, Any], fmu: Archive, settings: Mapping[str, Value], world_name: str | None
) -> tuple[list[Any], list[dict[str, str]], list[Any]]:
    """Roads with files read and settings applied; entries of `missing`; scenery."""
    roads, missing, scenery = list[Any](), list[dict[str, str]](), list[Any]()
    for road in scene.get("roads", []):
        variables = road.get("variables") or {}
        road_file = str(settings.get(variables.get("file", road.get("variable", "")), ""))
        name = road_file or str(road.get("path", "") if road["kind"] == "file" else "")
        if not name:
            if road["kind"] != "file":
                roads.append(_with_settings(road, settings))
            continue
        file = Path(name.removeprefix("file://"))
        try:
            world = world_beside(file)
            road_parts = [_scene_part(name, fmu)] if world is None else world["roads"]
        except HostError as error:
            missing.append({"name": f"The road {name}", "why": str(error).rstrip(".")})
            continue
        roads += [_with_friction_factor(part, variables, settings) for part in road_parts]
        if world is not None:
            scenery += world["scenery"]
        elif road_file and world_name:
            why = f"{file.with_suffix('.json')} is not there; {_command_text(file)}"
            missing.append({"name": f"The scenery of {world_name}", "why": why})
    return roads, missing, scenery


def _with_friction_factor(
    part: dict[str, Any], variables: Mapping[str, str], settings: Mapping[str, Value]
) -> dict[str, Any]:
    """A road from a file with the friction factor of the settings, if `variables` of the drawing name one."""
    if "friction_factor" not in variables:
        return part
    friction_variable = {"variables": {"friction_factor": variables["friction_factor"]}}
    return _with_settings({"friction_factor": 1.0} | part | friction_variable, settings)


def _with_settings(road: dict[str, Any], settings: Mapping[str, Value]) -> dict[str, Any]:
    """A road with the friction and the kerb of the settings; the higher side of the kerb keeps its height."""
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
        # Sides at equal height become a kerb that goes down along the road, as by default.
        entry["heights"] = [low, high] if first < last else [high, low]
    return entry


def _scene_part(name: str, fmu: Archive) -> dict[str, Any]:
    """The part of a scene for a road file. `name`: path, or name in the FMU."""
    with temporary_folder() as folder:
        packed_name = next((n for n in (name, f"{_ROADS}/{name}") if n in fmu), None)
        file = Path(name.removeprefix("file://"))
        if packed_name is not None:
            file = Path(folder, Path(packed_name).name)
            file.write_bytes(fmu.read(packed_name))
        elif not is_file(file):
            remedy = f"; {_command_text(file)}" if file.is_absolute() else ""
            raise HostError(f"its file is not there{remedy}")
        out = Path(folder, "part.json")
        run_ali3("road", str(file), "--part", str(out))
        part: dict[str, Any] = read_json(out, HostError)
        return part


def _command_text(road: Path) -> str:
    """A sentence with the command that makes the world of a road file again."""
    line = f"{command_name('road')} --world {quote(road.stem)} --out {quote(str(road.parent))}"
    return f"that of a world is made again by: {line}"


def scene_from(
    path: Path, settings: Mapping[str, Value] | None = None, world: str | None = None
) -> dict[str, Any] | None:
    """The scene of an FMU, or of a JSON file; see `scene_of`."""
    if not is_file(path):
        raise HostError(missing_file_text(path))
    if not is_archive(path):
        try:
            return read_scene(path)
        except SceneError as error:
            raise HostError(f"{path} is neither an FMU nor a scene: {error}") from None
    return scene_of(path, settings, world)
