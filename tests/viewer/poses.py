"""Poses of the frames of a scene over time, from the columns of a recording."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Vectors = NDArray[np.float64]

GROUND = "ground"


@dataclass(frozen=True)
class Poses:
    """A frame over time: earth = position + R(quaternion) local."""

    position: Vectors
    """Positions of its origin in earth axes, m, shape (n, 3)."""
    quaternion: Vectors
    """Unit quaternions, scalar first, of continuous sign, shape (n, 4)."""

    def points(self, local: Sequence[float] | Vectors) -> Vectors:
        """Earth positions of a point of the frame, of shape (n, 3)."""
        return self.position + rotated(self.quaternion, np.asarray(local, dtype=float))


class FramePoses:
    """Poses of all frames of a scene.

    Parameters
    ----------
    columns : mapping of str to array of shape (n,)
        With all that the frames read.
    count : int
        Number of times, n.
    """

    def __init__(self, scene: Mapping[str, Any], columns: Mapping[str, NDArray[Any]], count: int) -> None:
        self._frames = scene["frames"]
        self._columns = columns
        self._count = count
        still = Poses(np.zeros((count, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)))
        self._found: dict[str, Poses] = {GROUND: still}

    def of(self, name: str) -> Poses:
        """Poses of a frame."""
        if name not in self._found:
            frame = self._frames[name]
            if "way" in frame:
                poses = self._slid(frame)
            elif "parent" in frame:
                poses = self._turned(frame)
            elif "points" in frame:
                poses = self._carried(frame)
            else:
                poses = posed(self._stack(frame["position"]), self._stack(frame["quaternion"]))
            self._found[name] = poses
        return self._found[name]

    def points(self, anchor: Sequence[Any]) -> Vectors:
        """Earth positions of an anchor, of shape (n, 3)."""
        name, local = anchor
        return self.of(name).points(local)

    def _stack(self, names: Sequence[str]) -> Vectors:
        return np.column_stack([np.asarray(self._columns[name], dtype=float) for name in names])

    def _turned(self, frame: Mapping[str, Any]) -> Poses:
        parent = self.of(frame["parent"])
        angle = np.asarray(self._columns[frame["angle"]], dtype=float)
        turn = about_axis(frame["axis"], angle)
        return posed(parent.points(frame.get("at") or (0.0, 0.0, 0.0)), product(parent.quaternion, turn))

    def _slid(self, frame: Mapping[str, Any]) -> Poses:
        parent = self.of(frame["parent"])
        travel = np.asarray(self._columns[frame["way"]], dtype=float)
        at = np.asarray(frame.get("at") or (0.0, 0.0, 0.0), dtype=float)
        position = parent.points(at + travel[:, None] * np.asarray(frame["direction"], dtype=float))
        return Poses(position, parent.quaternion)

    def _carried(self, frame: Mapping[str, Any]) -> Poses:
        a, b, c = (self.points(anchor) for anchor in frame["on"])
        local = [np.array([p], dtype=float) for p in frame["points"]]
        rotation = axes_of_points(a, b, c) @ axes_of_points(*local).transpose(0, 2, 1)
        position = a - np.einsum("nij,j->ni", rotation, local[0][0])
        return posed(position, Rotation.from_matrix(rotation).as_quat(scalar_first=True))


def posed(position: Vectors, quaternion: Vectors) -> Poses:
    """Poses of unit quaternions, each on the side of the one before it."""
    turned = np.einsum("ni,ni->n", quaternion[1:], quaternion[:-1]) < 0.0
    sign = np.where(np.concatenate([[False], np.logical_xor.accumulate(turned)]), -1.0, 1.0)
    return Poses(position, quaternion * (sign / np.linalg.norm(quaternion, axis=1))[:, None])


def rotated(quaternion: Vectors, vector: Vectors) -> Vectors:
    """R(q) v, of shape (n, 3); one vector or n of them."""
    return _rotation(quaternion).apply(vector)


def product(a: Vectors, b: Vectors) -> Vectors:
    """Quaternion of R(a) R(b)."""
    return (_rotation(a) * _rotation(b)).as_quat(scalar_first=True)


def _rotation(quaternion: Vectors) -> Rotation:
    return Rotation.from_quat(quaternion, scalar_first=True)


def about_axis(axis: Sequence[float], angle: Vectors) -> Vectors:
    """Quaternions of right-handed turns about an axis by n angles, rad."""
    unit = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    return Rotation.from_rotvec(angle[:, None] * unit).as_quat(scalar_first=True)


def axes_of_points(a: Vectors, b: Vectors, c: Vectors) -> Vectors:
    """Axes of n triangles as columns: x from a to b, c in the plane of x and y."""
    x = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    to = c - a
    across = to - np.einsum("ni,ni->n", to, x)[:, None] * x
    y = across / np.linalg.norm(across, axis=1)[:, None]
    return np.stack([x, y, np.cross(x, y)], axis=2)
