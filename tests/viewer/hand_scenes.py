"""Scenes written by hand: one with every kind of object, and a mechanism with a run in closed form."""

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np

from ali3.scene.recording import Recording


def floats(values: Any) -> str:
    return base64.b64encode(np.asarray(values, "<f4").tobytes()).decode()


def indices(values: Any) -> str:
    return base64.b64encode(np.asarray(values, "<u4").tobytes()).decode()


def octets(values: Any) -> str:
    return base64.b64encode(np.asarray(values, np.uint8).tobytes()).decode()


def names(frame: str, parts: Sequence[str]) -> list[str]:
    return [f"{frame}.{part}" for part in parts]


def moving(frame: str) -> dict[str, Any]:
    return {"position": names(frame, "xyz"), "quaternion": names(frame, ("qw", "qx", "qy", "qz"))}


def everything() -> dict[str, Any]:
    """A scene with each key of the format."""
    return {
        "format": "ALi3 scene",
        "version": 1,
        "name": "everything",
        "description": "one of each",
        "up": [0, 0, 1],
        "planar": False,
        "extent": 3.0,
        "focus": "body",
        "frames": {
            "body": moving("body") | {"start": [[0, 0, 1], [1, 0, 0, 0]]},
            "spinning wheel": {"parent": "body", "at": [0, 1, 0], "axis": [0, 1, 0], "angle": "angle", "start": 0.1},
            "arm": {
                "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                "on": [["ground", [0, 0, 0]], ["body", [1, 0, 0]], ["body", [0, 1, 0]]],
                "start": [[0, 0, 0], [1, 0, 0, 0]],
            },
        },
        "shapes": [
            {
                "kind": "box",
                "name": "a box",
                "body": "body",
                "frame": "body",
                "at": [0, 0, 0],
                "size": [1, 0.5, 0.2],
                "axes": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
                "material": "paint",
                "color": "#3366cc",
                "opacity": 0.5,
            },
            {"kind": "sphere", "frame": "body", "at": [1, 0, 0], "radius": 0.1},
            {"kind": "cylinder", "frame": "arm", "ends": [[0, 0, 0], [1, 0, 0]], "radius": 0.05},
            {"kind": "tube", "points": [["ground", [0, 0, 0]], ["body", [0, 0, 0]]], "radius": 0.02},
            {
                "kind": "plate",
                "points": [["arm", [0, 0, 0]], ["arm", [1, 0, 0]], ["arm", [0, 1, 0]]],
                "thickness": 0.01,
            },
            {"kind": "mesh", "frame": "body", "mesh": "triangle", "at": [0, 0, 0], "axes": np.eye(3).tolist()},
            {
                "kind": "spring",
                "ends": [["ground", [0, 0, 0]], ["body", [0, 0, 0]]],
                "radius": 0.05,
                "wire": 0.01,
                "coils": 8,
            },
            {"kind": "damper", "ends": [["ground", [0, 0, 0]], ["body", [0, 0, 0]]], "radius": 0.02},
            {
                "kind": "wheel",
                "frame": "spinning wheel",
                "radius": 0.3,
                "width": 0.2,
                "rim": 0.2,
                "at": [0, 0, 0],
                "axis": [0, 1, 0],
            },
            {"kind": "steering_wheel", "frame": "spinning wheel", "radius": 0.2, "at": [0, 0, 0], "axis": [0, 1, 0]},
        ],
        "meshes": {
            "triangle": {
                "positions": floats([[0, 0, 0], [1, 0, 0], [0, 1, 0]]),
                "normals": floats([[0, 0, 1]] * 3),
                "triangles": indices([0, 1, 2]),
            }
        },
        "flexible": [
            {
                "frame": "body",
                "name": "frame",
                "nodes": [[0, 0, 0], [1, 0, 0]],
                "beams": [[0, 1]],
                "radii": [0.02],
                "amplitudes": ["body.mode_1"],
                "names": ["left", "right"],
                "start": [0.0],
                "note": "A beam of two nodes.",
                "computed": "stress.computed",
                "modes": floats([0, 0, 0, 0, 0, 0.1]),
                "stress": {
                    "fibres": 1,
                    "rows": floats([1e8, 2e8]),
                    "constant": floats([0, 0]),
                    "unit": "Pa",
                    "rule": "fibres",
                    "range": 1e8,
                    "limit": 2.5e8,
                    "limit_name": "yield stress",
                },
                "gauges": [{"name": "SG1", "value": "stress.SG1", "unit": "Pa", "nodes": [0, 1], "along": 0.25}],
            }
        ],
        "arrows": [
            {
                "name": "spring",
                "unit": "N",
                "value": "spring.force",
                "between": [["ground", [0, 0, 0]], ["body", [0, 0, 0]]],
                "sign": -1,
            },
            {"name": "pin", "unit": "N", "vector": names("pin", "xyz"), "axes": "ground", "at": ["body", [0, 0, 0]]},
            {
                "name": "tyre",
                "unit": "N",
                "tyre": {
                    "contact": names("contact", "xyz"),
                    "normal": names("normal", "xyz"),
                    "axis": names("axis", "xyz"),
                    "forces": names("tyre", ("Fx", "Fy", "Fz")),
                },
            },
        ],
        "roads": [
            {"kind": "flat", "height": 0.0, "note": "level", "variables": {"file": "road.file"}},
            {
                "kind": "grid",
                "origin": [0, 0],
                "spacing": [1, 1],
                "shape": [2, 2],
                "heights": floats([0, 0, 0, 0]),
                "frictions": floats([1, 1, 1, 1]),
            },
            {"kind": "plane", "point": [0, 0, 0], "normal": [0, 0.1, 1]},
            {
                "kind": "profile",
                "stations": [0, 1, 2],
                "heights": [0, 0.1, 0],
                "direction": [1, 0, 0],
                "origin": [0, 0, 0],
                "width": 3,
            },
            {"kind": "file", "variable": "road.file", "path": "resources/roads/plane.road"},
            {
                "kind": "terrain",
                "patches": [{"origin": [0, 0], "spacing": [1, 1], "shape": [2, 2], "heights": floats([0, 1, 2, 3])}],
                "surface": {
                    "origin": [0, 0],
                    "spacing": [1, 1],
                    "shape": [2, 2],
                    "classes": octets([0, 1, 1, 0]),
                    "names": ["asphalt", "grass"],
                    "frictions": [1, 0.5],
                },
            },
        ],
        "scenery": [
            {"kind": "line", "points": [[0, 0, 0], [1, 0, 0]], "width": 0.15, "colour": "white", "dash": [3, 6]},
            {"kind": "cone", "at": [0, 0, 0], "height": 0.5, "colour": "orange"},
            {"kind": "tree", "at": [0, 0, 0], "height": 9, "seed": 1},
            {"kind": "sign", "at": [0, 0, 0], "yaw": 0.5, "text": "20 %", "height": 2.5},
            {"kind": "barrier", "points": [[0, 0, 0], [1, 0, 0]], "height": 0.8},
            {"kind": "post", "at": [0, 0, 0], "height": 1},
            {"kind": "building", "at": [0, 0, 0], "yaw": 0, "size": [10, 6, 4]},
            {"kind": "arrow", "at": [0, 0, 0], "yaw": 0, "length": 4},
        ],
        "missing": [{"name": "lower arm", "why": "no output gives its motion"}],
    }


def crank(times: np.ndarray, speed: float = 2.0, name: str = "crank") -> Recording:
    """A crank of 0.5 m that turns about z at a constant rate and carries a slider, in the plane."""
    scene = {
        "format": "ALi3 scene",
        "version": 1,
        "name": "crank",
        "up": [0, 1, 0],
        "planar": True,
        "extent": 2.0,
        "frames": {"crank": moving("crank"), "slider": moving("slider")},
        "shapes": [
            {
                "kind": "cylinder",
                "frame": "crank",
                "ends": [[0, 0, 0], [0.5, 0, 0]],
                "radius": 0.04,
                "color": "#3366cc",
            },
            {"kind": "box", "frame": "slider", "size": [0.3, 0.2, 0.2], "color": "#cc3333"},
            {"kind": "tube", "points": [["crank", [0.5, 0, 0]], ["slider", [0, 0, 0]]], "radius": 0.03},
        ],
        "arrows": [{"name": "push", "unit": "N", "vector": ["fx", "fy", "fz"], "at": ["slider", [0, 0, 0]]}],
    }
    a = speed * times
    zero, one = np.zeros_like(a), np.ones_like(a)
    x = 0.5 * np.cos(a) + np.sqrt(1.0 - (0.5 * np.sin(a)) ** 2)
    columns = dict(zip(names("crank", "xyz"), (zero, zero, zero), strict=True))
    columns |= dict(zip(names("slider", "xyz"), (x, zero, zero), strict=True))
    for frame, angle in (("crank", a), ("slider", zero)):
        turn = (np.cos(angle / 2), zero, zero, np.sin(angle / 2))
        columns |= dict(zip(names(frame, ("qw", "qx", "qy", "qz")), turn, strict=True))
    columns |= {"angle": a, "fx": 100.0 * np.sin(a), "fy": zero, "fz": zero, "speed": speed * one}
    units = {"angle": "rad", "fx": "N", "fy": "N", "fz": "N", "speed": "rad/s"}
    return Recording(scene, times, columns, units, name)
