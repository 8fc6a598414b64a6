"""A page that runs FMUs: binary in WebAssembly, drawing, resources and variables of each, and the text of the page."""

import base64
import gzip
import json
import re
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import Any

from fmpy.model_description import ModelDescription

from ali3.archives import LARGEST_UNPACKED
from ali3.processes import command_name
from ali3.reading import is_file, read_bytes
from ali3.scene.recording import Recording
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import ROAD
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.description_file import opened
from hosts.fmu.description_record import description_record
from hosts.fmu.fmu import described
from hosts.fmu.fmu_file import snake_case
from hosts.fmu.geometry import RESOURCE, scene_of
from hosts.fmu.variables import Variables
from viewer.html_document import html_document
from viewer.page_data import page_data

PLATFORM = "wasm32"
_RESOURCES = "resources/"
_ROADS = "roads/"


@dataclass(frozen=True)
class FmuParts:
    """The parts of an FMU that a page needs to run it."""

    path: Path
    description: ModelDescription
    variables: Variables
    scene: dict[str, Any]
    wasm: bytes | None
    """The binary; None: the FMU has none."""
    resources: dict[str, bytes]
    """Files that the binary reads, by their paths inside the folder of the resources."""
    own_road: Path | None = None
    """A road file of the user among them."""

    @property
    def name(self) -> str:
        """Name of the model."""
        return str(self.description.modelName)

    def roads(self) -> dict[str, list[Any]]:
        """Roads of the drawing by values of the parameter `road.file`: empty, or the name of a road file in the FMU."""
        if ROAD not in self.variables.names:
            return {}
        own_road = None if self.own_road is None else self.own_road.name
        names = ["", *(path.removeprefix(_ROADS) for path in self.resources if path.startswith(_ROADS))]
        names = [name for name in names if name != own_road]
        with ThreadPoolExecutor() as pool:
            scenes = list(pool.map(lambda name: scene_of(self.path, {ROAD: name}), names))
        results = {name: scene["roads"] for name, scene in zip(names, scenes, strict=True) if scene is not None}
        return results if own_road is None else results | {own_road: self.scene["roads"]}

    def record(self, title: str) -> dict[str, Any]:
        """The FMU as JSON of the page; `wasm` must be there."""
        assert self.wasm is not None
        scene, additions = self.scene, dict[str, Any]()
        if self.own_road is not None:  # its long drawing is written once, among the roads
            world = {"road": self.own_road.name, "scenery": scene.get("scenery", [])}
            scene, additions = scene | {"roads": [], "scenery": []}, {"world": packed(json.dumps(world).encode())}
        return {
            "title": title,
            "scene": packed(json.dumps(scene).encode()),
            **additions,
            "roads": packed(json.dumps(self.roads()).encode()),
            "description": description_record(self.description, self.variables),
            "wasm": packed(self.wasm),
            "resources": {path: packed(content) for path, content in self.resources.items()},
        }


def fmu_parts(path: Path, road: Value = "") -> FmuParts:
    """Read an FMU for a page.

    `road`: of the parameter `road.file`: the name of a road in the FMU, or a road file, which goes into the page.
    Raises `HostError`: it is not an FMU that a page can run; with a remedy.
    """
    description = described(path)
    _check_kind(path, description)
    with opened(path) as archive:
        names = archive.names
        if RESOURCE not in names:
            raise HostError(
                f"{path} has no drawing of itself ({RESOURCE}), which FMUs that ali3 builds have; build it again with "
                f"{build_command(path)}"
            )
        binaries = [n for n in names if n.startswith(f"binaries/{PLATFORM}/") and n.endswith(".wasm")]
        wasm = archive.read(binaries[0]) if binaries else None
        files = [n for n in names if re.fullmatch(_RESOURCES + r"(?:[^/]+\.ali3|roads/.+\.road)", n)]
        resources = {name.removeprefix(_RESOURCES): archive.read(name) for name in sorted(files)}
    scene = scene_of(path, {ROAD: str(road)})
    assert scene is not None
    reason = next((item["why"] for item in scene["missing"] if item["name"] == f"The road {road}"), None)
    if road and reason is not None:
        raise HostError(f"The road {road} cannot be used: {reason}.")
    own_road = Path(str(road)) if road and is_file(str(road)) else None
    if own_road is not None:
        resources[_ROADS + own_road.name] = read_bytes(own_road, LARGEST_UNPACKED, HostError)
    return FmuParts(path, description, Variables(description), scene, wasm, resources, own_road)


def build_command(path: Path) -> str:
    """The command that builds an FMU of this file name for a page."""
    snake = snake_case(re.sub(r"(FMI3|FMI3Scalar|Python)$", "", path.stem))
    with opened(path) as archive:
        has_car = any(name.startswith(f"{_RESOURCES}car/") for name in archive.names)
    label = f"{'--car' if has_car else '--scene'} {quote(snake)}"
    out = "" if path.parent == Path("dist") else f" --out {quote(str(path.parent))}"
    return f"{command_name('build')} {label} --kind native --platforms this,{PLATFORM}{out}"


def _check_kind(path: Path, description: ModelDescription) -> None:
    tool = str(description.generationTool or "an unknown tool")
    if not tool.startswith("ALi3"):
        raise HostError(
            f"{path} is an FMU of {tool}; a page runs FMUs that {command_name('build')} has built, which carry a "
            "binary in WebAssembly and their drawing."
        )
    needs_python = "PythonFMU" in tool
    if description.fmiVersion != "2.0" or description.coSimulation is None or needs_python:
        kind = "the kind python, which needs a Python" if needs_python else f"FMI {description.fmiVersion}"
        raise HostError(f"{path} is an FMU of {kind}; a page runs the kind native (FMI 2.0): {build_command(path)}")


def packed(content: bytes) -> str:
    """Bytes as text of a page: base64 of gzip."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode("ascii")


def page_text(
    title: str,
    fmus: Sequence[tuple[str, FmuParts]],
    options: Mapping[str, Any],
    manoeuvre: Manoeuvre | None = None,
    recordings: Sequence[Recording] = (),
    ends: Sequence[str] = (),
) -> str:
    """The HTML file of a page. Raises `ViewerError`: the script of the viewer is not there and cannot be built.

    Parameters
    ----------
    fmus : sequence of (str, FmuParts)
        FMUs with their titles and binaries; they run in step, with the same inputs.
    options : mapping
        Of the page: ``name`` of what it records, ``run`` at once, ``start`` values, ``step``, ``plots``.
    manoeuvre : Manoeuvre, optional
        Inputs over time, until the user takes over.
    recordings : sequence of Recording
        Drawn beside the FMUs at the same time.
    ends : sequence of str
        Messages of the page at the end of each recording.
    """
    data: dict[str, Any] = {"fmus": [fmu.record(name) for name, fmu in fmus], "options": dict(options)}
    if manoeuvre is not None:
        data["script"] = packed(json.dumps(script_of(manoeuvre)).encode())
    if recordings:
        data["beside"] = page_data([recording.thinned() for recording in recordings], {})
        data["ends"] = list(ends)
    return html_document(title, data, "Drive")


def script_of(manoeuvre: Manoeuvre) -> dict[str, Any]:
    """Inputs over time as the page reads them.

    Raises `HostError`: the manoeuvre has a driver, whom a page does not have.
    """
    if manoeuvre.driver:
        raise HostError(
            f"The manoeuvre {manoeuvre.name} has a driver, who steers by what the car does; in a page a person drives. "
            "Give a table of inputs."
        )
    columns = {name: values.tolist() for name, values in manoeuvre.inputs.items()}
    return {"t": manoeuvre.time.tolist(), "columns": columns}
