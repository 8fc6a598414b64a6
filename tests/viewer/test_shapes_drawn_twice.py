"""The page and glTF files draw the same shapes: in each colour the same places and the same volume."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from viewer import page_build
from viewer.gltf.parts import Parts
from viewer.poses import FramePoses, rotated

PAGE = Path(page_build.__file__).parent / "page"
TURNED = [0.9, 0.1, -0.3, 0.2]
PLACES = {"car": (0.1, 0.2, 0.3), "left": (0.0, 0.9, 0.3), "right": (0.2, -0.9, 0.3), "above": (0.1, 0.2, 1.0)}
SHAPE = [
    {"kind": "wheel", "frame": "left", "radius": 0.3, "width": 0.2},
    {"kind": "wheel", "frame": "right", "radius": 0.3, "width": 0.2, "rim": 0.22, "axis": [0.0, 0.8, 0.6]},
    {"kind": "wheel", "frame": "above", "radius": 0.3, "width": 0.15, "at": [0.1, 0.0, 0.0]},
    {"kind": "steering_wheel", "frame": "car", "radius": 0.2, "axis": [-0.8, 0.0, 0.6], "color": "#203040"},
    {"kind": "damper", "radius": 0.04, "ends": [["car", [0.0, 0.0, -0.4]], ["left", [0.1, -0.3, 0.1]]]},
    {"kind": "spring", "radius": 0.07, "ends": [["car", [0.0, 0.0, -0.4]], ["left", [0.1, -0.3, 0.1]]], "seat": 0.2},
    {"kind": "box", "frame": "car", "at": [0.1, 0.0, 0.0], "size": [0.2, 0.4, 0.3]},
    {"kind": "cylinder", "frame": "car", "ends": [[0.0, 0.6, 0.0], [0.1, 0.6, 0.4]], "radius": 0.08},
    {"kind": "sphere", "frame": "car", "at": [0.1, 0.0, 0.0], "radius": 0.2},
    {"kind": "tube", "points": [["car", [0.0, 0.0, 0.0]], ["left", [0.0, 0.0, 0.0]]], "radius": 0.05},
]
CORNER = {"box": 0.04}
"""Share of the size by which places may differ; the page rounds the corners of a box."""
VOLUME = {"tube": np.inf}
"""Tubes of the page are open under their balls."""
NAMES = [f"{shape['kind']} {shape.get('frame', '')}".strip() for shape in SHAPE]


def scene() -> dict[str, Any]:
    def frame(name: str) -> dict[str, Any]:
        parts = ("qw", "qx", "qy", "qz")
        return {"position": [f"{name}.{a}" for a in "xyz"], "quaternion": [f"{name}.{a}" for a in parts]}

    head = {"format": "ALi3 scene", "version": 1, "name": "shapes", "extent": 2.0, "focus": "car"}
    return {**head, "frames": {name: frame(name) for name in PLACES}, "shapes": SHAPE}


def row() -> dict[str, float]:
    quaternion = np.array(TURNED) / np.linalg.norm(TURNED)
    names = ("x", "y", "z", "qw", "qx", "qy", "qz")
    return {f"{f}.{a}": float(v) for f, p in PLACES.items() for a, v in zip(names, (*p, *quaternion), strict=True)}


@pytest.fixture(scope="module")
def of_page() -> list[dict[str, Any]]:
    try:
        page_build.packages(PAGE)
        node = page_build.node()[0]
    except RuntimeError as error:
        pytest.skip(str(error))
    command, given = [node, str(PAGE / "test" / "shapes.mjs")], json.dumps([scene(), row()])
    made: list[dict[str, Any]] = json.loads(
        subprocess.run(command, input=given, capture_output=True, text=True, encoding="utf-8", check=True).stdout
    )
    return made


def of_file(shape: dict[str, Any]) -> dict[str, list[Any]]:
    """Positions in earth axes and triangles by colour."""
    parts = Parts(FramePoses(scene(), {n: np.array([v]) for n, v in row().items()}, 1), scene())
    parts.add(shape)
    assert not parts.notes
    found: dict[str, list[Any]] = {}
    places = [(parts.poses.of(frame), meshes) for frame, _, meshes in parts.fixed]
    for pose, meshes in [*places, *((motion, meshes) for _, motion, meshes in parts.free)]:
        for solid, surface in meshes:
            linear = np.array(surface.color[:3])
            shade = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
            colour = "tyre" if surface.name == "rubber" else bytes(np.round(255 * shade).astype(int).tolist()).hex()
            earth = pose.position[0] + rotated(np.tile(pose.quaternion[0], (len(solid.positions), 1)), solid.positions)
            found.setdefault(colour, []).append((earth, solid.triangles))
    return found


def middle(meshes: Any) -> np.ndarray:
    """Of the surface, m."""
    corners = [[p[t[:, k]] for k in range(3)] for p, t in meshes]
    areas = [np.linalg.norm(np.cross(b - a, c - a), axis=1) for a, b, c in corners]
    sums = [area @ (a + b + c) / 3.0 for area, (a, b, c) in zip(areas, corners, strict=True)]
    return np.asarray(sum(sums) / sum(area.sum() for area in areas))


def volume(meshes: Any) -> float:
    """About the middle, so that open surfaces count alike."""
    middle = np.mean([p.mean(axis=0) for p, _ in meshes], axis=0)
    corners = [[p[t[:, k]] - middle for k in range(3)] for p, t in meshes]
    return float(sum(np.einsum("ij,ij->", a, np.cross(b, c)) for a, b, c in corners) / 6.0)


@pytest.mark.parametrize("k", range(len(SHAPE)), ids=NAMES)
def test_the_page_and_files_draw_the_same(of_page: list[dict[str, Any]], k: int) -> None:
    shape = SHAPE[k]
    mine = of_file(shape)
    page = {
        colour: [(np.reshape(p, (-1, 3)), np.reshape(t, (-1, 3)).astype(int)) for p, t in meshes]
        for colour, meshes in of_page[k].items()
    }
    assert mine.keys() == page.keys()
    for colour, meshes in mine.items():
        ends = [[f(np.vstack([p for p, _ in m]), axis=0) for f in (np.min, np.max)] for m in (meshes, page[colour])]
        size = float(np.ptp(np.vstack(ends[0]), axis=0).max())
        assert np.abs(np.subtract(*ends)).max() < CORNER.get(str(shape["kind"]), 0.013) * size, colour
        assert middle(meshes) == pytest.approx(middle(page[colour]), abs=1e-3), colour
        assert volume(meshes) == pytest.approx(
            volume(page[colour]), rel=VOLUME.get(str(shape["kind"]), 0.025), abs=1e-9
        ), colour
