"""Reads glTF files in the tests: by hand, by three.js, and by the validator of Khronos."""

import base64
import json
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

from viewer import page_build

PAGE = Path(page_build.__file__).parent / "page"
TO_EARTH = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # from glTF's axes, y up


def run_node(script, *arguments):
    try:
        page_build.packages(PAGE)
        node = page_build.node()[0]
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
        made = json.loads(data)
        return made, base64.b64decode(made["buffers"][0]["uri"].partition(",")[2])
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def accessor(path, index):
    made, raw = content(path)
    found = made["accessors"][index]
    kind = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[found["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[found["type"]]
    start = made["bufferViews"][found["bufferView"]].get("byteOffset", 0)
    return np.frombuffer(raw, kind, found["count"] * width, start).reshape(-1, width).astype(float)


def world(path, times, name):
    """Earth matrices of the node of a name as three.js has them at times, (n, 4, 4)."""
    answer = run_node("read_gltf.mjs", path, *times)[0]
    index = [str(k) for k, node in enumerate(content(path)[0]["nodes"]) if node["name"] == name]
    assert len(index) == 1
    made = np.array([row[index[0]]["matrix"] for row in answer]).reshape(-1, 4, 4).transpose(0, 2, 1)
    turn = np.eye(4)
    turn[:3, :3] = TO_EARTH
    return turn @ made
