"""A corner of a car on a bumpy road, in closed form: every kind of frame and shape."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ali3.scene.recording import Recording
from tests.viewer.hand_scenes import floats, indices, moving

SPIN = 300.0  # rad/s
TOP, HUB = [0.0, 0.3, 0.3], [0.0, -0.1, 0.0]
FRONT, REAR = [-0.15, 0.3, -0.1], [0.15, 0.3, -0.1]
NODES = [[0.0, 0.0, 0.2], [0.5, 0.0, 0.2], [0.5, 0.3, 0.2], [0.0, 0.3, 0.4]]
BEAMS = [[0, 1], [1, 2], [2, 3]]
MODES = 12


def modes() -> NDArray[np.float64]:
    return 0.02 * np.random.default_rng(1).standard_normal((len(NODES), 3, MODES))


def amplitudes(t: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.column_stack([0.3 ** (k // 3) * np.sin((k + 3) * t) for k in range(MODES)])


def scene(parts: bool = True) -> dict[str, Any]:
    frames: dict[str, Any] = {
        "wheel": {"parent": "carrier", "at": [0.0, 0.05, 0.0], "axis": [0.0, 1.0, 0.0], "angle": "wheel.angle"},
        "arm": {
            "points": [[0.1, 0.0, 0.0], [0.4, 0.0, 0.0], [0.2, 0.4, 0.0]],
            "on": [["chassis", FRONT], ["chassis", REAR], ["carrier", HUB]],
        },
        "chassis": moving("chassis"),
        "carrier": moving("carrier"),
        "unused": moving("chassis"),
    }
    strut = [["chassis", TOP], ["carrier", HUB]]
    rng = np.random.default_rng(2)
    shapes: list[dict[str, Any]] = [
        {"kind": "box", "name": "body", "frame": "chassis", "size": [2, 0.6, 0.4], "material": "paint"},
        {"kind": "wheel", "frame": "wheel", "radius": 0.3, "width": 0.2},
        {"kind": "sphere", "frame": "chassis", "at": [0, 0, 0.5], "radius": 0.1, "opacity": 0.4, "color": "#00ff00"},
        {"kind": "cylinder", "frame": "arm", "ends": [[0.1, 0, 0], [0.4, 0, 0]], "radius": 0.03},
        {"kind": "tube", "points": [["chassis", FRONT], ["carrier", HUB], ["chassis", REAR]], "radius": 0.02},
        {"kind": "tube", "points": [["chassis", FRONT], ["chassis", REAR], ["chassis", TOP]], "radius": 0.02},
        {"kind": "plate", "points": [["chassis", FRONT], ["carrier", HUB], ["chassis", REAR]], "thickness": 0.01},
        {
            "kind": "plate",
            "points": [["ground", p] for p in ([0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0])],
            "thickness": 0.01,
        },
        {"kind": "spring", "name": "spring", "ends": strut, "radius": 0.06, "coils": 7},
        {"kind": "damper", "name": "damper", "ends": strut, "radius": 0.03},
        {"kind": "steering_wheel", "frame": "chassis", "radius": 0.2, "axis": [1, 0, 0.3]},
        {"kind": "mesh", "frame": "chassis", "mesh": "triangle", "at": [0, 0, 1]},
    ]
    scene_data: dict[str, Any] = {
        "format": "ALi3 scene",
        "version": 1,
        "name": "corner",
        "extent": 3.0,
        "focus": "chassis",
        "frames": frames,
        "shapes": shapes,
        "meshes": {
            "triangle": {"positions": floats([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), "triangles": indices([0, 1, 2])}
        },
    }
    if parts:
        scene_data["flexible"] = [
            {
                "frame": "chassis",
                "name": "frame",
                "nodes": NODES,
                "beams": BEAMS,
                "radii": [0.02] * len(BEAMS),
                "amplitudes": [f"mode_{k}" for k in range(MODES)],
                "modes": floats(modes()),
                "stress": {
                    "fibres": 4,
                    "rows": floats(1e8 * rng.standard_normal((len(BEAMS), 2, 4, MODES))),
                    "limit": 2.5e8,
                },
            }
        ]
        scene_data["roads"] = [
            {"kind": "flat", "height": 0.0},
            {
                "kind": "grid",
                "origin": [0, 0],
                "spacing": [0.5, 0.5],
                "shape": [30, 20],
                "heights": floats(rng.random((30, 20))),
            },
        ]
    return scene_data


def recording(t: NDArray[np.float64], parts: bool = True) -> Recording:
    columns: dict[str, NDArray[np.float64]] = {"wheel.angle": SPIN * t}
    for name in ("chassis", "carrier"):
        position, rotation = pose(name, t)
        columns |= {f"{name}.{c}": position[:, k] for k, c in enumerate("xyz")}
        q = rotation.as_quat()[:, [3, 0, 1, 2]]
        q[len(t) // 2 :] *= -1.0  # the sign of a quaternion means nothing
        columns |= {f"{name}.{c}": 1.1 * q[:, k] for k, c in enumerate(("qw", "qx", "qy", "qz"))}
    columns |= {f"mode_{k}": a for k, a in enumerate(amplitudes(t).T)}
    return Recording(scene(parts), t, columns)


def pose(name: str, t: NDArray[np.float64]) -> tuple[NDArray[np.float64], Rotation]:
    """Earth position and rotation of a frame."""
    if name == "chassis":
        at = np.column_stack([10 * t, 0.5 * np.sin(t), 0.5 + 0.05 * np.sin(7 * t)])
        turn = np.column_stack([0.3 * np.sin(t), 0.02 * np.sin(7 * t), 0 * t])
        return at, Rotation.from_euler("ZYX", turn)
    if name == "carrier":
        at = np.column_stack([10 * t, 0.5 * np.sin(t) + 0.8, 0.3 + 0 * t])
        return at, Rotation.from_rotvec(np.outer(0.5 * np.sin(t), [0, 0, 1]))
    if name == "wheel":
        at, turn = pose("carrier", t)
        return at + turn.apply([0.0, 0.05, 0.0]), turn * Rotation.from_rotvec(
            np.outer((SPIN * t) % (2 * np.pi), [0, 1, 0])
        )
    a, b, c = (place("chassis", FRONT, t), place("chassis", REAR, t), place("carrier", HUB, t))
    x = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    z = np.cross(x, c - a)
    z /= np.linalg.norm(z, axis=1)[:, None]
    rotation = Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=2))
    return a - rotation.apply([0.1, 0.0, 0.0]), rotation


def place(name: str, local: Any, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Earth positions of a point of a frame."""
    at, turn = pose(name, t)
    return at + turn.apply(np.asarray(local, dtype=float))
