"""Wheels of the cars: looked at along the axle, no two surfaces of different looks lie within a millimetre."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import mbs
from ali3.scene.recording import Recording
from ali3.scene.scene_columns import pose_columns
from mbs.vehicle import car_names, load
from tests.quick import quick
from tests.viewer.gltf_files import parts_of
from tests.viewer.poses import FramePoses
from viewer.gltf import write_gltf

LEAST = 1e-3
"""m: nearer surfaces flicker in each other."""
CROSSED = 2
"""Places at which two tubes that cross each other come so near; surfaces in each other do at many more."""
FACING = 0.7
PLACES = [[r * np.cos(a), r * np.sin(a)] for r in np.linspace(0.05, 0.9, 16) for a in np.linspace(0.1, 6.3, 29)]


def facing(file: Path, scene: dict[str, Any], wheel: dict[str, Any]) -> list[tuple[str, NDArray[np.float64]]]:
    """Looks and corners of what faces along the axle of a wheel, m; z outwards from its centre."""
    columns: dict[str, NDArray[np.float64]] = {name: np.zeros(1) for name in pose_columns(scene)}
    for frame in scene["frames"].values():
        for names, values in zip(
            (frame.get("position"), frame.get("quaternion")), frame.get("start", []), strict=False
        ):
            columns |= {name: np.array([value]) for name, value in zip(names, values, strict=True)}
    own, carrier = wheel["frame"], scene["frames"][wheel["frame"]]["parent"]
    at = np.array(scene["frames"][own]["at"])
    out = np.sign(FramePoses(scene, columns, 1).of(own).position[0, 1])
    results = []
    for part in parts_of(write_gltf(file, Recording(scene, np.zeros(1), columns), road=False).path):
        if part.frame not in (own, carrier):
            continue
        # At the start no wheel is turned, so that its axes are those of its carrier.
        x, y, z = (part.mesh.vertices - (at if part.frame == carrier else 0.0)).T
        corners = np.column_stack([x, z, out * y])[part.mesh.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(normals, axis=1)
        look = part.look["pbrMetallicRoughness"].get("baseColorFactor")
        results += [
            (f"{part.look['name']} {look}", triangle)
            for triangle in corners[np.abs(normals[:, 2]) > FACING * np.maximum(size, 1e-15)]
            if np.abs(triangle[:, 2]).max() < wheel["width"]
        ]
    return results


def too_near(surfaces: list[tuple[str, NDArray[np.float64]]], radius: float) -> set[tuple[str, str, int]]:
    """Pairs of looks less than a millimetre apart at more than `CROSSED` places, and the larger of their places, mm."""
    places = radius * np.array(PLACES)
    along: list[list[tuple[float, bool, str]]] = [[] for _ in places]
    for look, (a, b, c) in surfaces:
        low, high = np.minimum(np.minimum(a, b), c)[:2], np.maximum(np.maximum(a, b), c)[:2]
        near = np.flatnonzero(((places >= low) & (places <= high)).all(axis=1))
        (ux, uy), (vx, vy) = b[:2] - a[:2], c[:2] - a[:2]
        turn = ux * vy - uy * vx
        for k in near if turn else ():
            dx, dy = places[k] - a[:2]
            s, t = (dx * vy - dy * vx) / turn, (ux * dy - uy * dx) / turn
            if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
                along[k].append((a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]), bool(turn > 0.0), look))
    results: dict[tuple[str, str], list[int]] = {}
    for hits in along:
        hits.sort()
        for low, high in pairwise(hits):
            if low[2] != high[2] and low[1] == high[1] and high[0] - low[0] < LEAST:
                results.setdefault((low[2], high[2]), []).append(round(1e3 * high[0]))
    assert sum(map(len, along)) > 2 * len(places), "lines meet the wheel"
    return {(*pair, where) for pair, those in results.items() if len(those) > CROSSED for where in those}


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("prototype", "hatchback"), car_names(), "proof"))
def test_no_surfaces_of_a_hub_flicker(tmp_path: Path, name: str) -> None:
    scene = mbs.compile(load(name).model()).scene
    wheels = [shape for shape in scene["shapes"] if shape["kind"] == "wheel"]
    assert {
        wheel["frame"]: too_near(facing(tmp_path / "car.glb", scene, wheel), wheel["rim"])
        for wheel in wheels
        if "L" in wheel["frame"]
    } == {wheel["frame"]: set() for wheel in wheels if "L" in wheel["frame"]}


def test_a_disc_half_a_millimetre_behind_another_is_found() -> None:
    disc = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    three = [("steel", disc), ("rim", disc + np.array([0.0, 0.0, 5e-4])), ("paint", disc - np.array([0.0, 0.0, 2e-3]))]
    assert too_near(three, 0.3) == {("steel", "rim", 0)}
