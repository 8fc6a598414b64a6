"""Numbers of files as signals: what is text, layout or compression is left out."""

import base64
import binascii
import csv
import gzip
import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Signals = dict[str, NDArray[np.float64]]
_DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
_UNIT = re.compile(r" \[[^]]*\]$")


def of_csv(path: Path) -> Signals:
    """Columns of a table by their headings without units; empty cells and words are NaN."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns = zip(*rows[1:], strict=True)
    return {
        _UNIT.sub("", name): np.array([_number(c) for c in column])
        for name, column in zip(rows[0], columns, strict=True)
    }


def of_json(data: Any) -> Signals:
    """Numbers of a tree by their path; those of a list are one signal, and entries of a list go by their ``name``."""
    results: dict[str, list[float]] = {}
    _collect(data, "", results)
    return {path: np.array(values) for path, values in results.items()}


def of_json_file(path: Path) -> Signals:
    """The numbers of a JSON file."""
    return of_json(json.loads(path.read_text(encoding="utf-8")))


def of_xml(text: str | bytes) -> Signals:
    """Numeric attributes of elements, by kind of element and attribute, in the order of the file."""
    results: dict[str, list[float]] = {}
    for element in ET.fromstring(text).iter():
        for key, value in element.attrib.items():
            numbers = [_number(part) for part in value.split()]
            if numbers and not np.isnan(numbers).any():
                results.setdefault(f"{element.tag} {key}", []).extend(numbers)
    return {path: np.array(values) for path, values in results.items()}


def of_page(path: Path) -> Signals:
    """Scene and columns of a page."""
    match = _DATA.search(path.read_text(encoding="utf-8"))
    if match is None:
        raise ValueError(f"{path} has no data")
    data = json.loads(match[1])
    signals = {f"scene {key}": values for key, values in of_json(data["scenes"]).items()}
    for run in data["runs"]:
        for block in (run["time"], *run["blocks"]):
            octets = np.frombuffer(gzip.decompress(base64.b64decode(block["data"])), np.uint8)
            width = int(block["kind"][1])
            numbers = np.frombuffer(octets.reshape(width, -1).T.tobytes(), f"<{block['kind']}")
            for name, column in zip(block["names"], numbers.reshape(len(block["names"]), -1), strict=True):
                signals[f"column {name}"] = column.astype(float)
    return signals


def of_gltf(path: Path) -> Signals:
    """Meshes, places and motions of a glTF file, by the names of its nodes."""
    import pygltflib

    file = pygltflib.GLTF2().load(str(path))
    blob = file.binary_blob()
    signals: Signals = {}
    parts: dict[str, list[NDArray[np.float64]]] = {}

    def accessor(index: int) -> NDArray[np.float64]:
        a = file.accessors[index]
        kind = {5126: "<f4", 5125: "<u4", 5123: "<u2", 5121: "<u1"}[a.componentType]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[a.type]
        start = (file.bufferViews[a.bufferView].byteOffset or 0) + (a.byteOffset or 0)
        return np.frombuffer(blob, kind, a.count * width, start).astype(float)

    for node in file.nodes:
        for key in ("translation", "rotation", "scale", "matrix"):
            if (value := getattr(node, key)) is not None:
                parts.setdefault(f"node {node.name} {key}", []).append(np.array(value, float))
        if node.mesh is not None:
            for primitive in file.meshes[node.mesh].primitives:
                kinds = {k: v for k, v in vars(primitive.attributes).items() if v is not None}
                for key, index in (kinds | {"indices": primitive.indices}).items():
                    if isinstance(index, int):
                        parts.setdefault(f"mesh {node.name} {key}", []).append(accessor(index))
    for animation in file.animations:
        for channel in animation.channels:
            sampler = animation.samplers[channel.sampler]
            name = f"motion {file.nodes[channel.target.node].name} {channel.target.path}"
            parts.setdefault(name, []).extend([accessor(sampler.input), accessor(sampler.output)])
    for material in file.materials:
        pbr = material.pbrMetallicRoughness
        if pbr is not None and pbr.baseColorFactor is not None:
            parts.setdefault("materials", []).append(np.array(pbr.baseColorFactor, float))
    for name, arrays in parts.items():
        signals[name] = np.concatenate(arrays)
    return signals


def _collect(data: Any, path: str, found: dict[str, list[float]]) -> None:
    if isinstance(data, Mapping):
        for key, value in data.items():
            _collect(value, f"{path}.{key}" if path else str(key), found)
    elif isinstance(data, list):
        for value in data:
            name = value.get("name") if isinstance(value, Mapping) else None
            _collect(value, f"{path}[{name}]" if isinstance(name, str) else f"{path}[]", found)
    elif isinstance(data, bool | int | float):
        found.setdefault(path, []).append(float(data))
    elif isinstance(data, str) and (numbers := _encoded(data)) is not None:
        found.setdefault(path, []).extend(numbers.tolist())


def _encoded(text: str) -> NDArray[np.float64] | None:
    """Numbers of a text in base64 as scenes have them, single precision or whole; short texts are words."""
    if len(text) < 64 or " " in text:
        return None
    try:
        data = base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        return None
    if len(data) % 4:
        return np.frombuffer(data, np.uint8).astype(float)
    single, whole = np.frombuffer(data, "<f4"), np.frombuffer(data, "<u4").astype(float)
    size = np.abs(single[single != 0.0])
    return single.astype(float) if bool(((size > 1e-25) & (size < 1e25)).all()) else whole


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")
