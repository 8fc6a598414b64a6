"""Reads glTF files in the tests: by hand, by three.js, and by the validator of Khronos."""

import base64
import json
import struct
import subprocess
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from viewer import page_build

PAGE = Path(page_build.__file__).parent / "page"
TO_EARTH = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # from glTF's axes, y up


def run_node(script, *arguments):
    try:
        page_build.install_packages(PAGE)
        node = page_build.node_and_npm()[0]
    except RuntimeError as error:
        pytest.skip(str(error))
    command = [node, str(PAGE / "test" / script), *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    assert result.returncode == 0, result.stderr
    return [json.loads(line) for line in result.stdout.splitlines()]


def content(path):
    """JSON and bytes of a file, read by hand."""
    data = path.read_bytes()
    if path.suffix == ".gltf":
        record = json.loads(data)
        return record, base64.b64decode(record["buffers"][0]["uri"].partition(",")[2])
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def accessor(path, index):
    document, raw = content(path)
    result = document["accessors"][index]
    kind = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[result["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[result["type"]]
    start = document["bufferViews"][result["bufferView"]].get("byteOffset", 0)
    return np.frombuffer(raw, kind, result["count"] * width, start).reshape(-1, width).astype(float)


@cache
def _read(path, times):
    """Data of a file at times by three.js."""
    return run_node("read_gltf.mjs", path, *times)[0]


def world(path, times, name):
    """Earth matrices of the node of a name as three.js has them at times, (n, 4, 4); a path is read once."""
    answer = _read(path, tuple(times))
    index = [str(k) for k, node in enumerate(content(path)[0]["nodes"]) if node["name"] == name]
    assert len(index) == 1
    values = np.array([row[index[0]]["matrix"] for row in answer]).reshape(-1, 4, 4).transpose(0, 2, 1)
    turn = np.eye(4)
    turn[:3, :3] = TO_EARTH
    return turn @ values


class Part(NamedTuple):
    """What a node has of one look, where it is at the start."""

    node: str
    frame: str
    """Its parent node."""
    look: dict[str, Any]
    mesh: trimesh.Trimesh
    """Matrix in the axes of the frame."""
    normals: np.ndarray | None


def parts_of(path):
    """The triangles of a file, read by hand."""
    document = content(path)[0]
    frames = {child: node["name"] for node in document["nodes"] for child in node.get("children", ())}
    results = []
    for number, node in enumerate(document["nodes"]):
        for part in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            kept, triangles = np.unique(accessor(path, part["indices"]).astype(int), return_inverse=True)
            read = {key: accessor(path, index)[kept] for key, index in part["attributes"].items()}
            turn = Rotation.from_quat(node.get("rotation", [0.0, 0.0, 0.0, 1.0]))
            points = turn.apply(read["POSITION"] * node.get("scale", 1.0)) + node.get("translation", 0.0)
            mesh = trimesh.Trimesh(points, triangles.reshape(-1, 3), process=False)
            look = document["materials"][part["material"]]
            normals = turn.apply(read["NORMAL"]) if "NORMAL" in read else None
            results.append(Part(node["name"], frames.get(number, ""), look, mesh, normals))
    return results
