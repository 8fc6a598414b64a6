"""Writes recordings as glTF 2.0 animations, which Blender, three.js, Windows and macOS show."""

import json
import math
import os
import re
import subprocess
from base64 import b64encode
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.errors import reason
from ali3.files import check_writable, write_bytes
from ali3.scene.base64_numbers import encoded
from ali3.scene.decimation import chosen_times
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from ali3.scene.scene_columns import pose_columns
from ali3.scene.written_file import WrittenGltf
from ali3.temporary_folder import temporary_folder
from viewer.bundle import GLTF, bundle
from viewer.morph_targets import morph_targets
from viewer.page_build import node_and_npm

SUFFIXES = (".glb", ".gltf")
MAX_RATE = 240.0
_ERROR_LINE = re.compile(r"\s*(Uncaught )?\w*Error\b")
_MAX_SAMPLES = 20_000  # times at which errors are computed; at least two for each written time


def write_gltf(
    path: str | os.PathLike[str],
    recording: Recording,
    *,
    rate: float = 60.0,
    speed: float = 1.0,
    deformation: float = 1.0,
    road: bool = True,
) -> WrittenGltf:
    """Write the motion of a recording as a glTF 2.0 file with shapes, materials and one animation.

    Lengths are in metres and y is up, as glTF has it. The node of a frame has its name and moves with it; time 0 is
    the first of the recording. Farther than 1 km from the origin places are relative to one near the motion, which a
    note tells and the extras of the scene and of its first node have as ``origin``: earth axes, m. Motion is linear
    between the times, rotations go along great arcs. Flexible parts move by morph targets and have the colours of
    their stress at the time when it is largest, because glTF has no colours over time. Roads, scenery and the whole
    path are there as far as they are near the way. Arrows, plots, ghosts, marks and cameras are not in the file.

    Parameters
    ----------
    path : path
        ``.glb``, or ``.gltf`` with the numbers in it; its folder is made. An older file stays until the new one is
        complete.
    rate : float
        Largest number of times per second in the file, 1 to 240 Hz; a part that turns far between two of them has
        more.
    speed : float
        Speed of the animation; 1 is real time, 0.01 slow motion.
    deformation : float
        Factor of the drawn deformation.
    road : bool
        Whether roads, the surroundings and the path are drawn.

    Returns
    -------
    WrittenGltf
        Where it is, how large, and what was lost by thinning.

    Raises
    ------
    ViewerError
        The recording has no scene, nothing of it can be drawn, or an argument is wrong; or Node is not there, or fails.
    FileError
        The file cannot be written; an older one is then unchanged.
    """
    target = Path(path)
    scene = _checked_scene(target, recording, rate, speed, deformation)
    check_writable(path)
    begin, span = float(recording.t[0]), float(recording.t[-1] - recording.t[0]) / speed
    indices = chosen_times(recording.t, max(_MAX_SAMPLES, math.ceil(2.0 * rate * span)), recording.epoch)
    columns = {name: recording.columns[name][indices] for name in pose_columns(scene)}
    scene["flexible"] = [
        _with_morph_targets(part, number, columns) for number, part in enumerate(scene.get("flexible") or [])
    ]
    request = {
        "scene": scene,
        "names": list(columns),
        "count": len(indices),
        "name": recording.name,
        "rate": float(rate),
        "speed": float(speed),
        "begin": begin,
        "deformation": float(deformation),
        "ground": bool(road),
    }
    numbers = [(recording.t[indices] - begin) / speed, recording.epoch[indices], *columns.values()]
    answer, content = _run_writer(request, np.array(numbers))
    if not content:
        raise ViewerError(f"{recording.name!r} has no shape that can be drawn; there is nothing to write to {path}.")
    if target.suffix.lower() == ".gltf":
        content = _gltf_text(content)
    write_bytes(path, content)
    notes = list(recording.notes)
    notes += [f"{item['name']} is not drawn: {item['why']}" for item in recording.missing]
    notes += answer["notes"]
    if begin != 0.0:
        notes.append(f"Time 0 of the file is {begin:g} s of the recording.")
    if speed != 1.0:
        notes.append(f"A second of the file is {speed:g} s of the recording.")
    if scene.get("arrows"):
        notes.append("The arrows of forces are not in a glTF file.")
    distance, angle = answer["error"]
    return WrittenGltf(target, len(content), answer["times"], 1000.0 * distance, math.degrees(angle), notes)


def _checked_scene(target: Path, recording: Recording, rate: float, speed: float, deformation: float) -> dict[str, Any]:
    if target.suffix.lower() not in SUFFIXES:
        raise ViewerError(f"{target} must end with .glb or .gltf.")
    if not isinstance(recording, Recording):
        raise ViewerError(f"A recording is needed; this is an object of type {type(recording).__name__}.")
    if recording.scene is None:
        raise ViewerError(f"{recording.name!r} has no scene: there are no shapes to write to {target}.")
    limits = (("rate", rate, 1.0, MAX_RATE), ("speed", speed, 1e-6, 1e4), ("deformation", deformation, 0.0, 1e6))
    for name, value, low, high in limits:
        is_number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
        if not is_number or not low <= value <= high:
            raise ViewerError(f"The {name} is {value!r}; it must be a number from {low:g} to {high:g}.")
    return dict(recording.scene)


def _with_morph_targets(
    part: Mapping[str, Any], number: int, columns: dict[str, NDArray[np.float64]]
) -> dict[str, Any]:
    """A flexible part with its morph targets, whose weights are added to the columns."""
    shapes, weights, error = morph_targets(part, columns)
    names = [f"weight {k} of the flexible part {number}" for k in range(len(shapes))]
    columns |= dict(zip(names, weights.T, strict=True))
    return {**part, "targets": [encoded(shape) for shape in shapes], "weights": names, "reduction": error}


def _gltf_text(binary: bytes) -> bytes:
    """Convert a ``.glb`` file to the content of a ``.gltf`` file; not by Node, whose strings have at most 512 MiB."""
    length = int.from_bytes(binary[12:16], "little")
    description = json.loads(binary[20 : 20 + length])
    (buffer,) = description["buffers"]
    numbers = binary[28 + length :][: buffer["byteLength"]]
    buffer["uri"] = f"data:application/octet-stream;base64,{b64encode(numbers).decode()}"
    return json.dumps(description, ensure_ascii=False, separators=(",", ":")).encode()


def _run_writer(request: Mapping[str, Any], numbers: NDArray[np.float64]) -> tuple[dict[str, Any], bytes]:
    """Answer of the program of Node, and the content of its file; empty if nothing is drawn."""
    try:
        command = [node_and_npm()[0], str(bundle().with_name(GLTF))]
    except RuntimeError as error:
        raise ViewerError(f"A glTF file cannot be written. {error}") from None
    with temporary_folder() as folder:
        request_file, gltf_file = folder / "question", folder / "written"
        request_file.write_bytes(json.dumps(request).encode() + b"\n" + numbers.astype("<f8").tobytes())
        try:
            process = subprocess.run([*command, str(request_file), str(gltf_file)], capture_output=True, check=False)
        except OSError as error:
            raise ViewerError(f"A glTF file cannot be written: {command[0]} does not start: {reason(error)}.") from None
        if process.returncode != 0:
            lines = process.stderr.decode(errors="replace").splitlines()  # the message is before the stack
            fault = next((line.strip() for line in lines if _ERROR_LINE.match(line)), " ".join(lines)[:400])
            raise ViewerError(f"A glTF file cannot be written: the program that writes it failed ({fault}).")
        return json.loads(process.stdout), gltf_file.read_bytes() if gltf_file.exists() else b""
