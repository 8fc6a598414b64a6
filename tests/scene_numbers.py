"""What a drawing program computes from the part `flexible` of a scene: NumPy and the JSON alone."""

import base64
from collections.abc import Mapping
from typing import Any

import numpy as np


def numbers(text: str, shape: tuple[int, ...]) -> np.ndarray:
    """An array of the scene: base64 of little-endian float32, row by row."""
    return np.frombuffer(base64.b64decode(text), "<f4").astype(float).reshape(shape)


def amplitudes(part: Mapping[str, Any], columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Shape (times, modes)."""
    return np.column_stack([columns[name] for name in part["amplitudes"]])


def places(part: Mapping[str, Any], eta: np.ndarray) -> np.ndarray:
    """Deformed nodes in the axes of the part's frame, shape (times, nodes, 3), m."""
    nodes = np.array(part["nodes"])
    modes = numbers(part["modes"], (*nodes.shape, eta.shape[1]))
    return np.asarray(nodes + np.einsum("nik,tk->tni", modes, eta))


def rows_of_stress(part: Mapping[str, Any], eta: np.ndarray) -> np.ndarray:
    """What the rows of stress give, shape (times, beams, 2 ends, rows), Pa."""
    shape = (len(part["beams"]), 2, part["stress"]["fibres"], eta.shape[1])
    return np.einsum("berk,tk->tber", numbers(part["stress"]["rows"], shape), eta)


def stress(part: Mapping[str, Any], eta: np.ndarray) -> np.ndarray:
    """What the colours show at each end of each beam, shape (times, beams, 2), Pa."""
    rows = rows_of_stress(part, eta)
    if part["stress"]["rule"] == "round":
        return np.asarray(np.abs(rows[..., 0]) + np.hypot(rows[..., 1], rows[..., 2]))
    return np.asarray(np.abs(rows).max(axis=-1))


def turned(columns: Mapping[str, np.ndarray], frame: str, points: np.ndarray) -> np.ndarray:
    """Points of a frame, shape (times, n, 3), in earth axes by its columns of pose, m."""
    q = np.column_stack([columns[f"{frame}.q{c}"] for c in "wxyz"])[:, None]
    twice = 2.0 * np.cross(q[..., 1:], points)
    origin = np.column_stack([columns[f"{frame}.{c}"] for c in "xyz"])[:, None]
    return np.asarray(origin + points + q[..., :1] * twice + np.cross(q[..., 1:], twice))
